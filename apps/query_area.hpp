// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "geodb/map_query.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// A box whose sides lie along the axes of one CRS, asked of a map in another: a box of the map that holds
/// it. Sides are followed in 32 steps; a margin of 1 % covers what curves out between them.
MapQuery::Box covering_box(const MapQuery::Box& box, const Crs& from, const Crs& map);

/// True if the point is in the box, edges included. Longitudes count modulo 360: min_x > max_x goes round.
bool inside(const MapQuery::Box& box, const Point<MapCrs>& point, const Crs& crs);

/// Landmarks of any types, their order kept, in another CRS; those without a position there are left out.
std::vector<Landmark> in_crs(const std::vector<Landmark>& landmarks, const TypeRegistry& types,
                             const Crs& from, const Crs& to);

}  // namespace waymark
