// SPDX-License-Identifier: Apache-2.0
#include "exporters/view/view_terrain.hpp"

#include <algorithm>
#include <cmath>

#include "exporters/report/relief_picture.hpp"
#include "exporters/view/orthophoto_picture.hpp"

namespace waymark::exporters {
namespace {

/// Returns the height at x, y of the CRS between cell centres; NaN outside and beside unknown cells.
double relief_height(const Relief& relief, double x, double y) {
  const Grid<float>& heights = relief.heights;
  const double c = (x - relief.extent.west) / relief.extent.width() * double(heights.columns()) - 0.5;
  const double r = (relief.extent.north - y) / relief.extent.height() * double(heights.rows()) - 0.5;
  if (!(c >= -0.5 && r >= -0.5 && c <= double(heights.columns()) - 0.5 && r <= double(heights.rows()) - 0.5))
    return std::nan("");
  const auto column = std::clamp<std::int64_t>(std::int64_t(std::floor(c)), 0, heights.columns() - 2);
  const auto row = std::clamp<std::int64_t>(std::int64_t(std::floor(r)), 0, heights.rows() - 2);
  const double u = std::clamp(c - double(column), 0.0, 1.0), v = std::clamp(r - double(row), 0.0, 1.0);
  return (1 - v) * ((1 - u) * heights(column, row) + u * heights(column + 1, row)) +
         v * ((1 - u) * heights(column, row + 1) + u * heights(column + 1, row + 1));
}

/// A raster of the view frame: cell centres at `west` + i * step, `north` - j * step.
struct FrameRaster {
  double west = 0, north = 0, step = 1;
  std::int64_t columns = 2, rows = 2;

  Eigen::Vector2d at(std::int64_t column, std::int64_t row) const {
    return {west + step * double(column), north - step * double(row)};
  }
};

/// Divides a rectangle into at most `longest` steps along its longer side, nodes on the edges.
FrameRaster node_raster(const Eigen::AlignedBox2d& area, std::int64_t longest) {
  const double step = area.sizes().maxCoeff() / double(longest - 1);
  FrameRaster raster{area.min().x(), area.max().y(), step};
  raster.columns = std::max<std::int64_t>(2, std::llround(area.sizes().x() / step) + 1);
  raster.rows = std::max<std::int64_t>(2, std::llround(area.sizes().y() / step) + 1);
  return raster;
}

Grid<float> frame_heights(const Relief& relief, const CrsGrid& crs, const FrameRaster& raster) {
  Grid<float> heights(raster.columns, raster.rows);
  for (std::int64_t r = 0; r < raster.rows; ++r)
    for (std::int64_t c = 0; c < raster.columns; ++c) {
      const Eigen::Vector3d at = crs.at(raster.at(c, r));
      heights(c, r) = static_cast<float>(relief_height(relief, at.x(), at.y()) - at.z());
    }
  return heights;
}

Grid<Colour> shaded_picture(const Relief& relief, const CrsGrid& crs, const FrameRaster& raster,
                            const Body& body) {
  Relief framed{{raster.west - raster.step / 2, raster.north - (double(raster.rows) - 0.5) * raster.step,
                 raster.west + (double(raster.columns) - 0.5) * raster.step, raster.north + raster.step / 2},
                Grid<float>(raster.columns, raster.rows),
                raster.step,
                raster.step};
  for (std::int64_t r = 0; r < raster.rows; ++r)
    for (std::int64_t c = 0; c < raster.columns; ++c) {
      const Eigen::Vector3d at = crs.at(raster.at(c, r));
      framed.heights(c, r) = static_cast<float>(relief_height(relief, at.x(), at.y()));
    }
  return shade(framed, hypsometric_tint(framed, body));
}

void lay_over(Grid<Colour>& picture, const OrthophotoPicture& photo, const CrsGrid& crs,
              const FrameRaster& raster) {
  const Extent& e = photo.extent;
  for (std::int64_t r = 0; r < raster.rows; ++r)
    for (std::int64_t c = 0; c < raster.columns; ++c) {
      const Eigen::Vector3d at = crs.at(raster.at(c, r));
      const auto column =
          std::int64_t(std::floor((at.x() - e.west) / e.width() * double(photo.pixels.columns())));
      const auto row =
          std::int64_t(std::floor((e.north - at.y()) / e.height() * double(photo.pixels.rows())));
      if (photo.pixels.contains(column, row) && photo.pixels(column, row).alpha > 0)
        picture(c, r) = photo.pixels(column, row);
    }
}

double view_near_x(const ViewFrame& frame) {
  return frame.to_crs(Eigen::Vector3d::Zero()).x();
}

}  // namespace

std::optional<Eigen::AlignedBox2d> dem_area(const std::vector<std::string>& dems, const ViewFrame& frame) {
  const auto extent = relief_extent(dems, frame.crs(), view_near_x(frame));
  if (!extent) return {};
  Eigen::AlignedBox2d area;
  constexpr int steps = 16;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      const double x = extent->west + extent->width() * i / steps,
                   y = extent->south + extent->height() * j / steps;
      const Eigen::Vector3d at = frame.from_crs({{x, y, 0}});
      if (at.allFinite()) area.extend(Eigen::Vector2d(at.head<2>()));
    }
  return area.isEmpty() ? std::nullopt : std::optional(area);
}

ViewTerrain make_view_terrain(const std::vector<std::string>& dems, const std::string& orthophoto,
                              const ViewFrame& frame, const Eigen::AlignedBox2d& area, double level,
                              const TerrainBudget& budget) {
  const CrsGrid crs(frame, area);
  const auto relief = read_relief(dems, frame.crs(), view_near_x(frame), budget.pixels, crs.extent());
  const FrameRaster nodes = node_raster(area, relief ? budget.nodes : 2);
  const FrameRaster pixels = node_raster(area, budget.pixels);
  ViewTerrain terrain{.west = nodes.west,
                      .south = nodes.north - nodes.step * double(nodes.rows - 1),
                      .step = nodes.step,
                      .heights = {},
                      .picture = {},
                      .caption = {}};
  Grid<Colour> picture(pixels.columns, pixels.rows, Colour{128, 128, 128});
  if (relief) {
    terrain.heights = frame_heights(*relief, crs, nodes);
    terrain.caption = "shaded relief";
    picture = shaded_picture(*relief, crs, pixels, frame.crs().body());
  }
  if (!orthophoto.empty()) {
    lay_over(picture,
             read_orthophoto(orthophoto, frame.crs(), view_near_x(frame), crs.extent(), budget.pixels), crs,
             pixels);
    if (!relief) terrain.heights = Grid<float>(nodes.columns, nodes.rows, static_cast<float>(level));
    terrain.caption = "orthophoto";
  }
  if (!terrain.heights.cells().empty()) terrain.picture = encode_jpeg(picture, 84);
  return terrain;
}

}  // namespace waymark::exporters
