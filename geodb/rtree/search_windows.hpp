// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "geo/body.hpp"
#include "geo/crs.hpp"
#include "geodb/map_query.hpp"
namespace waymark::geodb {

/// Disjoint boxes in map coordinates that cover a region. A geographic CRS has one box for each range of
/// longitudes (-180..180, 0..360) that the map may use.
using SearchWindows = std::vector<MapQuery::Box>;

/// Returns one window without bounds.
SearchWindows whole_plane();
/// Returns the windows of a box.
SearchWindows search_windows(const Crs& crs, const MapQuery::Box& box);
/// Returns windows that contain the circle, also about a pole; the caller tests the distance.
SearchWindows search_windows(const Crs& crs, const MapQuery::Near& near);

bool contains(const SearchWindows& windows, double x, double y);

/// Distance in metres between two points in map coordinates: geodesic in a geographic CRS, planar otherwise.
class MapDistance {
 public:
  explicit MapDistance(const Crs& crs);
  double operator()(double x0, double y0, double x1, double y1) const;

 private:
  std::optional<Geodesic> geodesic_;
  double metres_per_unit_;
};

}  // namespace waymark::geodb
