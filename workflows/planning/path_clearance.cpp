// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/path_clearance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/error.hpp"
#include "geo/axes_rotation.hpp"
#include "geo/point_at_height.hpp"
#include "importers/rasters/dem.hpp"
#include "planning/clearance.hpp"

namespace waymark::workflows {
namespace {

constexpr double kSds = 2;  // standard deviations by which pose and heights may be off

/// Range of a DEM whose surface is bilinear between its nodes: that of all nodes about a square.
class DemRange {
 public:
  DemRange(const std::vector<std::string>& files, const RobotMap& map) : frame_(map.frame) {
    dem_ = importers::import_dem({.files = files,
                                  .nodata = NodataPolicy::unknown,
                                  .crs = map.crs().kind() == CrsKind::local ? "local" : "",
                                  .inspect = false});
    const GridGeometry& grid = dem_->geometry();
    if (grid.cells() > 25'000'000)
      throw Error(ErrorCode::input, fmt::format("the DEM has {} cells, too many for --dem", grid.cells()),
                  files.front(), "cut out the surroundings of the route: gdal_translate -projwin");
    if (!grid.where.crs.same_as(map.crs())) transform_.emplace(map.crs(), grid.where.crs);
    heights_ = dem_->read({0, 0, grid.columns, grid.rows});
  }

  double height_sd() const { return dem_->height_sd(); }

  std::optional<planning::HeightRange> operator()(const Eigen::Vector2d& middle, double half) const {
    const auto crs = frame_.crs_from_map_frame({{middle.x(), middle.y(), 0}}).xyz;
    CrsTransform::XY at{crs.x(), crs.y()};
    if (transform_) at = (*transform_)(at.x, at.y);
    const Georeference& where = dem_->geometry().where;
    const double metres = where.crs.metres_per_unit();
    const double columns = half / (where.dx * metres), rows = half / (std::abs(where.dy) * metres);
    const double c = where.column(at.x), r = where.row(at.y);
    planning::HeightRange range{std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
    for (double row = std::floor(r - rows); row <= std::ceil(r + rows); ++row)
      for (double column = std::floor(c - columns); column <= std::ceil(c + columns); ++column) {
        const auto i = static_cast<std::int64_t>(column), j = static_cast<std::int64_t>(row);
        if (!heights_.contains(i, j) || heights_(i, j) == kNoHeight) return {};
        range.low = std::min(range.low, heights_(i, j)), range.high = std::max(range.high, heights_(i, j));
      }
    return range;
  }

 private:
  LocalFrame frame_;
  std::shared_ptr<const importers::ImportedDem> dem_;
  std::optional<CrsTransform> transform_;
  HeightWindow heights_;
};

}  // namespace

std::string add_clearance(const RouteRequest& request, const RobotMap& map, RouteResult& result) {
  if (request.dem.empty()) return {};
  const planning::Vehicle vehicle = planning::find_vehicle(request.vehicle);
  const DemRange terrain(request.dem, map);
  double min_clearance = std::numeric_limits<double>::infinity(), max_tilt = 0;
  std::size_t unknown = 0;
  for (PlannedRoute& route : result.routes)
    for (RouteStation& station : route.stations) {
      const Eigen::Vector2d at = plan_position(map.frame, station.at.x(), station.at.y());
      station.clearance = planning::clearance_bounds(
          {at.x(), at.y(), station.yaw - grid_rotation(map.frame, at)}, vehicle,
          [&](const Eigen::Vector2d& middle, double half) { return terrain(middle, half); },
          kSds * station.sd, kSds * terrain.height_sd());
      if (!station.clearance)
        ++unknown;
      else if (&route == &result.routes.front())
        min_clearance = std::min(min_clearance, station.clearance->belly),
        max_tilt = std::max(max_tilt, station.clearance->tilt);
    }
  std::string text;
  if (std::isfinite(min_clearance))
    text = fmt::format("  {}: clearance of at least {:.2f} m, tilt of at most {:.1f} deg{}\n", vehicle.name,
                       min_clearance, max_tilt,
                       min_clearance < 0 || max_tilt > vehicle.max_slope.value
                           ? ", by bounds that hold for any error: touching is not ruled out"
                           : "");
  if (unknown) text += fmt::format("  {} stations are on unknown terrain\n", unknown);
  return text;
}

}  // namespace waymark::workflows
