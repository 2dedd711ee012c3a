// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>
#include "core/attribute.hpp"
#include "exporters/web/tile_id.hpp"
#include "exporters/web/web_projection.hpp"
namespace waymark::exporters {

/// Layer of polygons on a web map.
struct WebShapeLayer {
  std::string name, title, summary;
  std::string colour, fill;                 ///< of outline and area, "#rrggbb"
  std::vector<AttributeSpec> columns = {};  ///< by number of the properties
  std::vector<std::string> keys = {};       ///< their names
  std::int64_t count = 0;
};

/// Polygon on the world.
struct WebShape {
  struct Ring {
    std::vector<Eigen::Vector2d> points =
        {};                ///< not closed; x beyond [0, 1) if it crosses the edge of the world
    bool is_hole = false;  ///< of the last ring that is none
  };
  std::uint32_t layer = 0;
  std::vector<Ring> rings = {};
  Eigen::AlignedBox2d box = {};
  std::uint64_t first = 0;
  std::uint32_t size = 0;  ///< of the properties, bytes
};

/// Polygons of a map: 16 bytes a vertex.
struct WebShapes {
  std::vector<WebShapeLayer> layers = {};  ///< that have polygons: stands, then crowns
  std::vector<WebShape> shapes = {};       ///< in the order of layers
  std::string properties = {};             ///< lists of append_property
  std::int64_t outside = 0;                ///< polygons beyond the edges of the world, left out
};

/// Reads the stands and the tree crowns of a map. Columns by classes of diameter are left out.
WebShapes read_web_shapes(const std::filesystem::path& map, const WebProjection& projection);

/// Returns the rectangle that contains all polygons.
WebBounds bounds_of(const WebShapes& shapes);

/// Returns the coarsest zoom whose steps are at most 5 cm, or 1e-5 of the width of the map. `world_width`:
/// metres.
int top_zoom(const WebShapes& shapes, double world_width);

/// Tile, and the polygons that reach into it.
struct ShapeTile {
  TileId id;
  std::vector<std::uint32_t> shapes = {};  ///< ascending
};

/// Returns the tiles of a zoom, ascending by pmtiles_id. Polygons smaller than 4 pixels are left out below
/// `top`.
std::vector<ShapeTile> shape_tiles(const WebShapes& all, int zoom, int top);

/// Returns the gzipped vector tile. Vertices nearer than half a pixel are merged below `top`; polygons are
/// cut at 64 steps beyond the edges of the tile.
std::string shape_tile(const WebShapes& all, const ShapeTile& tile, int top);

/// Returns the metadata of an archive of the polygons: TileJSON's `vector_layers`.
std::string shape_metadata(const WebShapes& all, const std::string& title, int top);

}  // namespace waymark::exporters
