// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "geo/body.hpp"
#include "geo/crs.hpp"
#include "geodb/map_query.hpp"
namespace waymark {

/// Boxes in map coordinates that together hold all of a region, none twice. On a geographic CRS one for each
/// way longitudes may be written (-180..180, 0..360), split where the region crosses the antimeridian.
using SearchWindows = std::vector<MapQuery::Box>;

/// All of the plane.
SearchWindows everywhere();
SearchWindows windows_of(const Crs& crs, const MapQuery::Box& box);
/// Hold every point within the radius, also round a pole; the distance itself must be tested.
SearchWindows windows_of(const Crs& crs, const MapQuery::Near& near);

bool inside(const SearchWindows& windows, double x, double y);

/// Metres on the ground between two points in map coordinates: geodesic on a geographic CRS, planar
/// otherwise.
class GroundRuler {
 public:
  explicit GroundRuler(const Crs& crs);
  double operator()(double x0, double y0, double x1, double y1) const;

 private:
  std::optional<Geodesic> geodesic_;
  double metres_per_unit_;
};

}  // namespace waymark
