// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "core/attribute.hpp"
#include "geo/crs.hpp"
#include "geodb/map_query.hpp"
namespace waymark {

/// Layers of a map beside its landmarks: crowns, stands, a machine's track, harvested trees. Each is a table
/// of its name with plane geometries in the map's CRS and any attributes.
enum class ShapeKind { point, line, polygon };

/// One connected piece. Point: `outer` is one place. Line: `outer` is its two or more corners. Polygon: rings
/// of three or more corners, closed or not, in any sense; `holes` lie inside `outer`.
struct ShapePart {
  std::vector<Eigen::Vector2d> outer;
  std::vector<std::vector<Eigen::Vector2d>> holes = {};
  friend bool operator==(const ShapePart&, const ShapePart&) = default;
};

/// A row. No part: no geometry. Points have at most one part.
struct Shape {
  std::vector<ShapePart> parts;
  std::vector<AttributeValue> values;  ///< in the order of the layer's columns; monostate is NULL
};

/// How QGIS draws the layer on opening the map.
struct ShapeStyle {
  std::string colour = "#888888";  ///< of lines, outlines and markers
  std::string fill = {};           ///< of polygons, "#rrggbb"; empty: not filled
  double fill_opacity = 0.35;      ///< (0, 1]
  double width = 0.3;              ///< of lines and outlines, mm
  std::string label = {};          ///< column written into the shape; empty: none
};

/// Gives rows one by one as they are written: for layers too large to be held. Those near each other should
/// follow each other, as the spatial index takes them in this order.
using ShapeMaker = std::function<void(const std::function<void(const Shape&)>& take)>;

/// Name and column names are [a-z][a-z0-9_]*. Columns `id` and `geom` are made and may not be named.
struct ShapeLayer {
  std::string name, summary;
  ShapeKind kind = ShapeKind::polygon;
  std::vector<AttributeSpec> columns = {};
  std::vector<Shape> rows = {};
  ShapeStyle style = {};
  ShapeMaker more = {};  ///< after `rows`
};

namespace sqlite {
class Database;
}

/// Writes layers into an open map: table, registration, extent, column descriptions, packed RTree, style. A
/// layer of the same name is replaced. Inside the caller's transaction. Rows keep their order: ids from 1.
/// Throws Error{input} for a name that is taken by a landmark type or another table, rows whose values do not
/// fit the columns, rings that are too short, and coordinates that are not finite.
void write_layers(const sqlite::Database& database, std::span<const ShapeLayer> layers,
                  std::string_view changed);

/// The same for a map file that exists, all layers or none: a process killed meanwhile leaves the map as it
/// was. All that is written is held until then, so that readers are shut out for a moment only, unless
/// `file` is one nobody else reads. Throws Error as MapEditor::open does.
enum class MapFile { shared, own };
void write_layers(const std::filesystem::path& map, std::span<const ShapeLayer> layers,
                  MapFile file = MapFile::shared);

/// Names of the shape layers of a map, sorted.
std::vector<std::string> shape_layers(const std::filesystem::path& map);

/// Reads one back. Throws Error{input} where the map has no such layer.
ShapeLayer read_shape_layer(const std::filesystem::path& map, std::string_view name);
/// The same without the rows, which are given one at a time after `begin(layer)`; those whose boxes meet
/// `window` (map coordinates) alone, where it is given.
void visit_shape_layer(const std::filesystem::path& map, std::string_view name,
                       const std::function<void(const ShapeLayer&)>& begin,
                       const std::function<void(Shape&&)>& visit,
                       const std::optional<MapQuery::Box>& window = {});
/// Rows of a layer; 0 where the map has none of that name.
std::int64_t count_shapes(const std::filesystem::path& map, std::string_view name);

}  // namespace waymark
