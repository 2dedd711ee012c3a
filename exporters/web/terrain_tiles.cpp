// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/terrain_tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

namespace waymark::exporters {
namespace {

constexpr int kNodes = 17;  // per side of a tile: exact positions there, bilinear between
constexpr int kEdgeParts = 32;

/// Returns how many whole turns of longitude bring a position near the middle of an extent.
double turns(const Crs& crs, const Extent& extent, double x) {
  if (crs.kind() != CrsKind::geographic || !std::isfinite(x)) return 0;
  return 360 * std::round((extent.west + extent.width() / 2 - x) / 360);
}

/// Positions of the map's CRS at the nodes of a tile.
class TileNodes {
 public:
  TileNodes(const TileId& id, const WebProjection& projection, const Crs& crs, const Extent& extent) {
    const auto at = [&](double column, double row) {
      return projection.from_world({std::ldexp(id.column + column / (kNodes - 1), -id.zoom),
                                    std::ldexp(id.row + row / (kNodes - 1), -id.zoom)});
    };
    const double turn = turns(crs, extent, at(kMiddle, kMiddle).x());
    for (int row = 0; row < kNodes; ++row) {
      for (int column = 0; column < kNodes; ++column)
        node(column, row) = at(column, row) + Eigen::Vector2d(turn, 0);
      if (crs.kind() == CrsKind::geographic) continue_longitudes(row);
    }
  }

  /// `u`, `v`: parts of the tile's side, from the north-west.
  Eigen::Vector2d at(double u, double v) const {
    const double c = u * (kNodes - 1), r = v * (kNodes - 1);
    const int column = std::min(static_cast<int>(c), kNodes - 2),
              row = std::min(static_cast<int>(r), kNodes - 2);
    const double s = c - column, t = r - row;
    return (1 - t) * ((1 - s) * node(column, row) + s * node(column + 1, row)) +
           t * ((1 - s) * node(column, row + 1) + s * node(column + 1, row + 1));
  }

 private:
  static constexpr int kMiddle = (kNodes - 1) / 2;

  /// Lets longitudes ascend eastwards from the middle, beyond half a turn if need be.
  void continue_longitudes(int row) {
    for (int column = kMiddle + 1; column < kNodes; ++column)
      if (node(column, row).x() < node(column - 1, row).x()) node(column, row).x() += 360;
    for (int column = kMiddle - 1; column >= 0; --column)
      if (node(column, row).x() > node(column + 1, row).x()) node(column, row).x() -= 360;
  }
  const Eigen::Vector2d& node(int column, int row) const {
    return nodes_[static_cast<std::size_t>(row * kNodes + column)];
  }
  Eigen::Vector2d& node(int column, int row) {
    return nodes_[static_cast<std::size_t>(row * kNodes + column)];
  }
  std::array<Eigen::Vector2d, kNodes * kNodes> nodes_;
};

}  // namespace

Colour terrarium(double height) {
  const auto steps =
      static_cast<std::uint32_t>(std::clamp(std::round((height + 32768) * 256), 0.0, 16777215.0));
  return {static_cast<std::uint8_t>(steps >> 16), static_cast<std::uint8_t>(steps >> 8 & 255),
          static_cast<std::uint8_t>(steps & 255), 255};
}

TerrainTiles::TerrainTiles(const Crs& crs, WebPlane plane, const Relief& relief)
    : crs_(crs), extent_(relief.extent), pyramid_(relief.heights) {
  const WebProjection projection(crs, plane);
  double previous = 0.5;
  const auto place = [&](double u, double v) -> std::optional<Eigen::Vector2d> {
    double y = std::lerp(extent_.south, extent_.north, v);
    if (crs.kind() == CrsKind::geographic) y = std::clamp(y, -kMaxWebLatitude, kMaxWebLatitude);
    auto at = projection.to_world(std::lerp(extent_.west, extent_.east, u), y);
    if (!at) return std::nullopt;
    if (plane == WebPlane::mercator) at->x() += std::round(previous - at->x());
    previous = at->x();
    bounds_.west = std::min(bounds_.west, at->x()), bounds_.east = std::max(bounds_.east, at->x());
    bounds_.north = std::min(bounds_.north, at->y()), bounds_.south = std::max(bounds_.south, at->y());
    return at;
  };
  constexpr double part = 1.0 / kEdgeParts;
  for (int j = 0; j <= kEdgeParts; ++j)
    for (int i = 0; i <= kEdgeParts; ++i) {
      // Rows alternate, so that neighbours follow each other and longitudes continue.
      place(j % 2 == 0 ? i * part : 1 - i * part, j * part);
    }
  constexpr std::array<std::array<double, 2>, 5> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
  previous = (bounds_.west + bounds_.east) / 2;
  place(0.5, 0.5);
  place(0, 0.5);
  place(0, 0);
  for (std::size_t side = 0; side < 4; ++side)
    for (int i = 0; i < kEdgeParts; ++i)
      if (const auto at = place(std::lerp(corners[side][0], corners[side + 1][0], i * part),
                                std::lerp(corners[side][1], corners[side + 1][1], i * part)))
        outline_.push_back(*at);
  const auto middle = place(0.5, 0.5);
  const double middle_y = middle ? middle->y() : 0.5;
  const double cells = projection.world_width(middle_y) / std::min(relief.cell_x, relief.cell_y);
  max_zoom_ = std::clamp(static_cast<int>(std::ceil(std::log2(cells / kPixels) - 0.5)), 0, 22);
}

std::vector<TileId> TerrainTiles::tiles() const {
  std::vector<TileId> all;
  for (int zoom = 0; zoom <= max_zoom_; ++zoom) {
    const std::int64_t side = std::int64_t{1} << zoom;
    const auto index = [&](double world) {
      return static_cast<std::int64_t>(std::floor(std::ldexp(world, zoom)));
    };
    std::set<std::pair<std::uint64_t, std::int64_t>> found;  // by position on the curve
    const std::int64_t first = index(bounds_.west), last = std::min(index(bounds_.east), first + side - 1);
    for (std::int64_t row = std::max<std::int64_t>(0, index(bounds_.north));
         row <= std::min(side - 1, index(bounds_.south)); ++row)
      for (std::int64_t column = first; column <= last; ++column) {
        const auto wrapped = static_cast<std::uint32_t>((column % side + side) % side);
        found.insert({hilbert_of({zoom, wrapped, static_cast<std::uint32_t>(row)}), row * side + wrapped});
      }
    for (const auto& [curve, cell] : found)
      all.push_back({zoom, static_cast<std::uint32_t>(cell % side), static_cast<std::uint32_t>(cell / side)});
  }
  return all;
}

Grid<float> TerrainTiles::heights(const TileId& id, const WebProjection& projection) const {
  const TileNodes nodes(id, projection, crs_, extent_);
  const Grid<float>& base = pyramid_.level(0);
  const double columns = double(base.columns()) / extent_.width(),
               rows = double(base.rows()) / extent_.height();
  const int level = std::min(max_zoom_ - id.zoom, pyramid_.levels() - 1);
  Grid<float> heights(kPixels, kPixels);
  for (int row = 0; row < kPixels; ++row)
    for (int column = 0; column < kPixels; ++column) {
      const Eigen::Vector2d at = nodes.at((column + 0.5) / kPixels, (row + 0.5) / kPixels);
      const bool has_image = at.allFinite();  // a part of the world that the map's CRS does not reach
      heights(column, row) =
          has_image ? pyramid_.at(level, (at.x() - extent_.west) * columns, (extent_.north - at.y()) * rows)
                    : pyramid_.at(pyramid_.levels() - 1, 0, 0);
    }
  return heights;
}

std::string TerrainTiles::tile(const TileId& id, const WebProjection& projection) const {
  const Grid<float> metres = heights(id, projection);
  Grid<Colour> picture(kPixels, kPixels);
  for (std::size_t i = 0; i < picture.cells().size(); ++i) picture.cells()[i] = terrarium(metres.cells()[i]);
  return encode_rgb_png(picture);
}

}  // namespace waymark::exporters
