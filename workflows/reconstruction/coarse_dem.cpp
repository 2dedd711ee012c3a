// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/coarse_dem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/rasters/dem.hpp"

namespace waymark::workflows {
namespace {

Crs map_of_dem(const Georeference& where, const GridGeometry& geometry, const std::string& file) {
  if (where.crs.kind() != CrsKind::geographic) return where.crs;
  if (where.crs.body().name != earth().name)
    throw Error(ErrorCode::usage, fmt::format("the coarse DEM is in degrees of {}", where.crs.body().name),
                file, "pass a projected CRS of that body by --crs");
  const double column = double(geometry.columns) / 2, row = double(geometry.rows) / 2;
  return Crs::from_text(importers::utm_zone(where.x(column), where.y(row)));
}

}  // namespace

CoarseDem::CoarseDem(std::string file, const std::optional<Crs>& map) : file_(std::move(file)) {
  importers::DemImport import{.files = {file_}, .nodata = NodataPolicy::unknown, .inspect = false};
  if (map && map->kind() == CrsKind::local) import.crs = "local";
  dem_ = importers::import_dem(import);
  const Georeference& where = dem_->geometry().where;
  map_ = map ? *map : map_of_dem(where, dem_->geometry(), file_);
  if (!where.crs.same_as(map_)) to_dem_.emplace(map_, where.crs);
  unit_ = map_.kind() == CrsKind::local ? 1 : map_.metres_per_unit();
}

double CoarseDem::height(double x, double y) const {
  const Georeference& where = dem_->geometry().where;
  const CrsTransform::XY at =
      to_dem_ ? (*to_dem_)(x / unit_, y / unit_) : CrsTransform::XY{x / unit_, y / unit_};
  const double c = where.column(at.x), r = where.row(at.y);
  if (!(std::abs(c) < 1e9 && std::abs(r) < 1e9)) return kNoHeight;
  const auto i = static_cast<std::int64_t>(std::floor(c)), j = static_cast<std::int64_t>(std::floor(r));
  const HeightWindow cells = dem_->read({i, j, 2, 2});
  const double a = c - double(i), b = r - double(j);
  return (1 - b) * ((1 - a) * cells(0, 0) + a * cells(1, 0)) + b * ((1 - a) * cells(0, 1) + a * cells(1, 1));
}

double CoarseDem::cell(double x, double y) const {
  constexpr double kStep = 1;  // metre
  const auto column = [&](double at_x) {
    const CrsTransform::XY at =
        to_dem_ ? (*to_dem_)(at_x / unit_, y / unit_) : CrsTransform::XY{at_x / unit_, y / unit_};
    return Eigen::Vector2d(dem_->geometry().where.column(at.x), dem_->geometry().where.row(at.y));
  };
  return kStep / (column(x + kStep) - column(x)).norm();
}

pipeline::CoarseHeights CoarseDem::sample(const Eigen::Vector2d& middle, double side,
                                          std::int64_t nodes) const {
  pipeline::CoarseHeights out{.grid = {.west = middle.x() - side / 2,
                                       .north = middle.y() + side / 2,
                                       .cell = side / double(nodes),
                                       .columns = nodes,
                                       .rows = nodes},
                              .heights = Grid<float>(nodes, nodes),
                              .sd = dem_->height_sd()};
  for (std::int64_t r = 0; r < nodes; ++r)
    for (std::int64_t c = 0; c < nodes; ++c) {
      const double h = height(out.grid.x(double(c)), out.grid.y(double(r)));
      out.heights(c, r) = std::isfinite(h) ? static_cast<float>(h) : std::numeric_limits<float>::quiet_NaN();
    }
  return out;
}

pipeline::CoarseHeights CoarseDem::sample_all(std::int64_t nodes) const {
  const GridGeometry& geometry = dem_->geometry();
  std::optional<CrsTransform> to_map;
  if (to_dem_) to_map.emplace(geometry.where.crs, map_);
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  constexpr int kSteps = 16;  // along each side
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const double x = geometry.where.x(double(geometry.columns - 1) * i / kSteps),
                   y = geometry.where.y(double(geometry.rows - 1) * j / kSteps);
      const auto at = to_map ? (*to_map)(x, y) : CrsTransform::XY{x, y};
      if (!std::isfinite(at.x) || !std::isfinite(at.y)) continue;
      low = low.cwiseMin(Eigen::Vector2d(at.x, at.y) * unit_);
      high = high.cwiseMax(Eigen::Vector2d(at.x, at.y) * unit_);
    }
  const double side = (high - low).maxCoeff();
  return sample((low + high) / 2, side, std::min(nodes, std::max(geometry.columns, geometry.rows)));
}

pipeline::CoarseHeights read_coarse_dem(const std::string& file, const PosedImages& posed) {
  constexpr int kNodes = 256;  // across
  const CoarseDem dem(file, posed.crs);
  const double unit = posed.crs.kind() == CrsKind::local ? 1 : posed.crs.metres_per_unit();
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  double above = 0;
  bool covered = false;
  for (const ImageHandle& image : posed.images) {
    const Eigen::Vector3d centre = image->info().view->centre().xyz;
    low = low.cwiseMin(centre.head<2>());
    high = high.cwiseMax(centre.head<2>());
    const double below = dem.height(centre.x(), centre.y());
    if (!std::isfinite(below)) continue;
    covered = true;
    if (!(centre.z() > below))
      throw Error(
          ErrorCode::input,
          fmt::format("image {} lies {:.1f} m below the coarse DEM", image->info().name, below - centre.z()),
          file,
          "heights of cameras and DEM may refer to different zeros (geoid, ellipsoid, take-off): shift one "
          "of them");
    above = std::max(above, centre.z() - below);
  }
  if (!covered)
    throw Error(
        ErrorCode::input, "the coarse DEM has no height below any of the images", file,
        fmt::format("the cameras lie between x {:.1f} and {:.1f}, y {:.1f} and {:.1f} in {}: check --crs",
                    low.x() / unit, high.x() / unit, low.y() / unit, high.y() / unit, posed.crs.id()));
  return dem.sample((low + high) / 2, (high - low).maxCoeff() + 4 * above, kNodes);
}

}  // namespace waymark::workflows
