// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::inline landmarks {

/// Returns the uid of a landmark, e.g. "mt-3kq8zt0v5d1xj". It is stable over runs, tiles and threads.
/// - It consists of the initials of the type and a 64-bit hash of type, CRS id and position in Crockford's
///   base 32 (without i, l, o, u).
/// - Positions are rounded to 1e-7 degrees or 1 cm; longitudes are equal modulo 360 degrees.
/// - Two of 1e6 landmarks share a uid with probability 3e-8.
std::string make_uid(const LandmarkType& type, const Crs& crs, const Point<MapCrs>& position);

/// Assigns uids to all landmarks. Duplicates get the suffixes "-2", "-3", ... in the given order: sort first.
void assign_uids(const TypeRegistry& types, const Crs& crs, std::span<Landmark> landmarks);

}  // namespace waymark::inline landmarks
