// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/sight_terrain.hpp"

#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.hpp"
#include "pipeline/engine/progress_meter.hpp"

namespace waymark::workflows {
namespace {

constexpr std::int64_t kBlock = 64;  // nodes per side
constexpr double kLift = 1000;       // m, between the heights at which positions are computed

/// Where a point of the map frame lies in a DEM.
struct DemPoint {
  Eigen::Vector2d pixel;      ///< column and row on the tangent plane
  Eigen::Vector2d per_metre;  ///< of height above that plane: the verticals are not parallel
  double height = 0;          ///< of the tangent plane above the datum, m

  DemPoint operator*(double factor) const { return {pixel * factor, per_metre * factor, height * factor}; }
  DemPoint operator+(const DemPoint& o) const {
    return {pixel + o.pixel, per_metre + o.per_metre, height + o.height};
  }
  Eigen::Vector2d at(double z) const { return pixel + per_metre * (z - height); }
};

/// Positions of the map frame in a DEM. For one thread.
class DemPositions {
 public:
  DemPositions(const GridGeometry& grid, const LocalFrame& frame) : where_(grid.where), frame_(frame) {
    if (!where_.crs.same_as(frame.crs())) to_dem_.emplace(frame.crs(), where_.crs);
  }

  DemPoint operator()(double x, double y) const {
    const Eigen::Vector3d plane = frame_.crs_from_map_frame({{x, y, 0}}).xyz;
    const Eigen::Vector2d low = pixel(plane), high = pixel(frame_.crs_from_map_frame({{x, y, kLift}}).xyz);
    return {low, (high - low) / kLift, frame_.crs().kind() == CrsKind::local ? 0 : plane.z()};
  }

 private:
  Eigen::Vector2d pixel(const Eigen::Vector3d& at) const {
    CrsTransform::XY in_dem{at.x(), at.y()};
    if (to_dem_) in_dem = (*to_dem_)(at.x(), at.y());
    return {where_.column(in_dem.x), where_.row(in_dem.y)};
  }

  Georeference where_;
  LocalFrame frame_;
  std::optional<CrsTransform> to_dem_;
};

/// Returns the box of a DEM in the map frame; `std::nullopt` if its border has points without an image.
std::optional<Eigen::AlignedBox2d> box_of(const GridGeometry& grid, const LocalFrame& frame) {
  if (grid.wraps || grid.north_pole || grid.south_pole) return {};
  std::optional<CrsTransform> to_map;
  if (!grid.where.crs.same_as(frame.crs())) to_map.emplace(grid.where.crs, frame.crs());
  constexpr int kPieces = 32;
  Eigen::AlignedBox2d box;
  for (int i = 0; i <= kPieces; ++i)
    for (int j = 0; j <= kPieces; ++j) {
      if (i % kPieces != 0 && j % kPieces != 0) continue;  // inside
      const double x = grid.where.x(static_cast<double>(grid.columns - 1) * i / kPieces),
                   y = grid.where.y(static_cast<double>(grid.rows - 1) * j / kPieces);
      const CrsTransform::XY in_map = to_map ? (*to_map)(x, y) : CrsTransform::XY{x, y};
      const Eigen::Vector2d at = frame.map_frame_from_crs({{in_map.x, in_map.y, 0}}).xyz.head<2>();
      if (!at.allFinite()) return {};
      box.extend(at);
    }
  return box;
}

struct Nodes {
  double x0 = 0, y0 = 0, step = 1;
  std::int64_t columns = 2, rows = 2;
};

Nodes nodes_of(const GridGeometry& grid, const LocalFrame& frame, const Eigen::AlignedBox2d& area,
               double max_nodes) {
  const Eigen::Vector2d middle = area.center();
  const DemPositions positions(grid, frame);
  const Eigen::Vector2d here = positions(middle.x(), middle.y()).pixel;
  const double per_metre = std::max((positions(middle.x() + 1, middle.y()).pixel - here).norm(),
                                    (positions(middle.x(), middle.y() + 1).pixel - here).norm());
  const Eigen::Vector2d size = area.sizes();
  double step = per_metre > 0 && std::isfinite(per_metre) ? 0.5 / per_metre : size.maxCoeff() / 1000;
  step = std::max({step, std::sqrt(size.prod() / max_nodes), size.maxCoeff() / max_nodes, 1e-3});
  return {area.min().x(), area.max().y(), step,
          std::max<std::int64_t>(2, static_cast<std::int64_t>(std::ceil(size.x() / step)) + 1),
          std::max<std::int64_t>(2, static_cast<std::int64_t>(std::ceil(size.y() / step)) + 1)};
}

/// Bilinear height; NaN if one of the four cells is unknown or outside the window.
double height_at(const HeightWindow& heights, double column, double row) {
  const double c0 = std::floor(column), r0 = std::floor(row), u = column - c0, v = row - r0;
  if (!(c0 >= 0 && r0 >= 0 && c0 + 1 < static_cast<double>(heights.columns()) &&
        r0 + 1 < static_cast<double>(heights.rows())))
    return std::numeric_limits<double>::quiet_NaN();
  const auto c = static_cast<std::int64_t>(c0), r = static_cast<std::int64_t>(r0);
  return (1 - v) * ((1 - u) * heights(c, r) + u * heights(c + 1, r)) +
         v * ((1 - u) * heights(c, r + 1) + u * heights(c + 1, r + 1));
}

void fill_block(std::int64_t column, std::int64_t row, const Nodes& nodes, const DemSource& dem,
                const DemPositions& positions, Grid<float>& out) {
  std::array<DemPoint, 4> corner;
  Eigen::AlignedBox2d box;
  for (std::size_t k = 0; k < 4; ++k) {
    corner[k] = positions(nodes.x0 + static_cast<double>(column + (k % 2 ? kBlock : 0)) * nodes.step,
                          nodes.y0 - static_cast<double>(row + (k / 2 ? kBlock : 0)) * nodes.step);
    for (const double z : {kMinHeight, kMaxHeight})
      if (corner[k].per_metre.norm() * kMaxHeight > 1) box.extend(corner[k].at(z));
    box.extend(corner[k].pixel);
  }
  if (!box.min().allFinite() || !box.max().allFinite()) return;
  const GridGeometry& grid = dem.geometry();
  const auto limited = [](double at, std::int64_t count) {
    return static_cast<std::int64_t>(std::clamp(at, -2.0, static_cast<double>(count) + 1));
  };
  const std::int64_t c0 = limited(std::floor(box.min().x()) - 2, grid.columns),
                     c1 = limited(std::ceil(box.max().x()) + 2, grid.columns),
                     r0 = limited(std::floor(box.min().y()) - 2, grid.rows),
                     r1 = limited(std::ceil(box.max().y()) + 2, grid.rows);
  if (!(c1 > c0 && r1 > r0)) return;
  const HeightWindow heights = dem.read({c0, r0, c1 - c0 + 1, r1 - r0 + 1});
  for (std::int64_t r = row; r < std::min(row + kBlock, out.rows()); ++r)
    for (std::int64_t c = column; c < std::min(column + kBlock, out.columns()); ++c) {
      const double u = static_cast<double>(c - column) / kBlock, v = static_cast<double>(r - row) / kBlock;
      const DemPoint at = corner[0] * ((1 - u) * (1 - v)) + corner[1] * (u * (1 - v)) +
                          corner[2] * ((1 - u) * v) + corner[3] * (u * v);
      const auto height = [&](const Eigen::Vector2d& pixel) {
        return height_at(heights, pixel.x() - static_cast<double>(c0), pixel.y() - static_cast<double>(r0));
      };
      const double first = height(at.pixel);
      const double z = std::isfinite(first) ? height(at.at(first)) : first;
      if (std::isfinite(z)) out(c, r) = static_cast<float>(z);
    }
}

}  // namespace

Terrain sight_terrain(const DemSource& dem, const LocalFrame& frame, const Eigen::AlignedBox2d& given,
                      const SightTerrainRules& rules) {
  Eigen::AlignedBox2d area = given;
  if (const auto covered = box_of(dem.geometry(), frame)) area = area.intersection(*covered);
  if (area.isEmpty())
    throw Error(ErrorCode::input, "the DEM does not meet the area from which landmarks can be seen",
                fmt::format("{}", fmt::join(dem.files(), ", ")), "pass a DEM of the map's area");
  const Nodes nodes = nodes_of(dem.geometry(), frame, area, static_cast<double>(rules.max_nodes));
  Grid<float> heights(nodes.columns, nodes.rows, std::numeric_limits<float>::quiet_NaN());
  const std::int64_t bands = (nodes.rows + kBlock - 1) / kBlock;
  pipeline::ProgressMeter meter(rules.progress, "terrain", bands);
  tbb::parallel_for(std::int64_t{0}, bands, [&](std::int64_t band) {
    const DemPositions positions(dem.geometry(), frame);
    for (std::int64_t column = 0; column < nodes.columns; column += kBlock) {
      fill_block(column, band * kBlock, nodes, dem, positions, heights);
      meter.add(static_cast<double>(std::min(kBlock, nodes.columns - column)) /
                static_cast<double>(nodes.columns));
    }
  });
  meter.finish();
  return Terrain(std::move(heights), nodes.x0, nodes.y0, nodes.step, nodes.step);
}

}  // namespace waymark::workflows
