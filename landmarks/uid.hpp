// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// A name for a landmark that depends on what and where it is, and on nothing else: the same over runs, tiles
/// and threads. E.g. "mt-3kq8zt0v5d1xj": the type's initials, then 64 bits of a hash of type, CRS id and
/// position in Crockford's base 32 (no i, l, o, u). Positions are rounded to 1e-7 degrees or 1 cm; a whole
/// turn of longitude makes no difference. Two of 1e6 landmarks share a name with probability 3e-8.
std::string make_uid(const LandmarkType& type, const Crs& crs, const Point<MapCrs>& position);

/// Names all landmarks. Those that would share a name get "-2", "-3", ... in the order given: sort first.
void assign_uids(const TypeRegistry& types, const Crs& crs, std::span<Landmark> landmarks);

}  // namespace waymark
