// SPDX-License-Identifier: Apache-2.0
#include "geo/metric_crs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark::inline geo {
namespace {

constexpr double kNorthEnd = 84, kSouthEnd = -80;  // of UTM, degrees

std::string earth_crs(double lon, double lat) {
  if (lat > kNorthEnd) return "EPSG:5041";
  if (lat < kSouthEnd) return "EPSG:5042";
  const int zone = std::clamp(static_cast<int>(std::floor((lon + 180) / 6)) + 1, 1, 60);
  return fmt::format("EPSG:{}{:02}", lat < 0 ? 327 : 326, zone);
}

}  // namespace

std::string fitting_metric_crs(const GridGeometry& grid) {
  const double lon = std::remainder(grid.where.x(static_cast<double>(grid.columns - 1) / 2), 360.0);
  const double lat = grid.where.y(static_cast<double>(grid.rows - 1) / 2);
  const Body& body = grid.where.crs.body();
  if (body.name == earth().name) return earth_crs(lon, lat);
  const std::string shape =
      fmt::format("+a={} +b={:.10g} +units=m +no_defs", body.equatorial_radius, body.polar_radius());
  if (lat > kNorthEnd || lat < kSouthEnd)
    return fmt::format("'+proj=stere +lat_0={} {}'", lat > 0 ? 90 : -90, shape);
  return fmt::format("'+proj=tmerc +lat_0={:.4f} +lon_0={:.4f} {}'", lat, lon, shape);
}

}  // namespace waymark::inline geo
