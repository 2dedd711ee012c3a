// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "exporters/report/relief_picture.hpp"
#include "exporters/report/relief_source.hpp"
#include "exporters/web/height_pyramid.hpp"
#include "exporters/web/tile_id.hpp"
#include "exporters/web/web_projection.hpp"
namespace waymark::exporters {

/// Terrain as RGB tiles of 256 pixels per side (Terrarium): height = red * 256 + green + blue / 256 - 32768
/// metres, so steps of 4 mm. Thread-safe.
class TerrainTiles {
 public:
  static constexpr int kPixels = 256;

  /// `relief` has at least one height.
  TerrainTiles(const Crs& crs, WebPlane plane, const Relief& relief);

  /// Returns the zoom at which a pixel is about a cell of the relief.
  int max_zoom() const { return max_zoom_; }
  /// Returns the rectangle of the relief; west may be below 0, east above 1.
  const WebBounds& bounds() const { return bounds_; }
  /// Returns the outline of the relief on the world, against the clock as seen from above, not closed.
  const std::vector<Eigen::Vector2d>& outline() const { return outline_; }
  /// Lists the tiles of all zooms that the relief touches, ascending by pmtiles_id.
  std::vector<TileId> tiles() const;
  /// Returns a tile as a PNG file. `projection`: one of the same CRS and plane, used by this thread only.
  std::string tile(const TileId& id, const WebProjection& projection) const;
  /// Returns the height of a pixel's centre before it is rounded, metres.
  Grid<float> heights(const TileId& id, const WebProjection& projection) const;

 private:
  Crs crs_;
  Extent extent_;
  HeightPyramid pyramid_;
  WebBounds bounds_{1e9, 1, -1e9, 0};
  std::vector<Eigen::Vector2d> outline_;
  int max_zoom_ = 0;
};

/// Returns the colour of a height in metres; heights beyond the range of the format are clamped.
Colour terrarium(double height);

}  // namespace waymark::exporters
