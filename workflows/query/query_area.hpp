// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "geodb/map_query.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::workflows {

/// Returns a box in the map's CRS that covers a box in another CRS. Sides are sampled in 32 steps; a margin
/// of 1 % covers the curvature between them.
geodb::MapQuery::Box covering_box(const geodb::MapQuery::Box& box, const Crs& from, const Crs& map);

/// Returns true if the point is in the box or on its edge. Longitudes count modulo 360: min_x > max_x crosses
/// the antimeridian.
bool inside(const geodb::MapQuery::Box& box, const Point<MapCrs>& point, const Crs& crs);

/// Returns landmarks of any types in another CRS, in the same order. Those without a position there are left
/// out.
std::vector<Landmark> transform_landmarks(const std::vector<Landmark>& landmarks, const TypeRegistry& types,
                                          const Crs& from, const Crs& to);

}  // namespace waymark::workflows
