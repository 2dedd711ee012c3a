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
namespace waymark::geodb {

/// Geometry type of a shape layer. Shape layers are the layers of a map other than landmarks: crowns, stands,
/// tracks, harvested trees. Each is a table of two-dimensional geometries in the map's CRS, with attributes.
enum class ShapeKind { point, line, polygon };

/// Connected part of a geometry. Point: `outer` is one position. Line: `outer` has two or more vertices.
/// Polygon: rings of three or more vertices, closed or not, in any orientation; `holes` lie inside `outer`.
struct ShapePart {
  std::vector<Eigen::Vector2d> outer;
  std::vector<std::vector<Eigen::Vector2d>> holes = {};
  friend bool operator==(const ShapePart&, const ShapePart&) = default;
};

/// Row of a shape layer. Without parts it has no geometry. Points have at most one part.
struct Shape {
  std::vector<ShapePart> parts;
  std::vector<AttributeValue> values;  ///< in the order of the layer's columns; monostate is NULL
};

/// Default style of a layer in QGIS.
struct ShapeStyle {
  std::string colour = "#888888";  ///< of lines, outlines and markers
  std::string fill = {};           ///< of polygons, "#rrggbb"; empty: not filled
  double fill_opacity = 0.35;      ///< (0, 1]
  double width = 0.3;              ///< of lines and outlines, mm
  std::string label = {};          ///< column that labels the shape; empty: none
  std::string graduated =
      {};  ///< column of numbers by which polygons are filled, white to `fill`; empty: all alike
  std::vector<double> classes = {};  ///< ascending bounds of the classes of `graduated`, from first to last
};

/// Generator of rows for layers larger than memory; calls `take` for each row. Rows near each other should be
/// consecutive, since the spatial index uses this order.
using ShapeGenerator = std::function<void(const std::function<void(const Shape&)>& take)>;

/// Shape layer. Layer and column names are [a-z][a-z0-9_]*; columns `id` and `geom` are reserved.
struct ShapeLayer {
  std::string name, summary;
  ShapeKind kind = ShapeKind::polygon;
  std::vector<AttributeSpec> columns = {};
  std::vector<Shape> rows = {};
  ShapeStyle style = {};
  ShapeGenerator generator = {};  ///< after `rows`
};

namespace sqlite {
class Database;
}

/// Writes layers into an open map, in the caller's transaction: table, registration, extent, column
/// descriptions, packed RTree, style.
/// - Replaces a layer of the same name. Rows have ids from 1 in their order.
/// - Throws Error{input} for a name of a landmark type or another table, and for rows whose values do not fit
///   the columns.
/// - Throws Error{input} for rings that are too short and coordinates that are not finite.
void write_layers(const sqlite::Database& database, std::span<const ShapeLayer> layers,
                  std::string_view changed);

/// Access of other processes to a map file while it is written.
enum class MapAccess {
  shared,     ///< readers are blocked only during the commit; memory grows with the changes
  exclusive,  ///< no other process reads the file; memory is bounded
};
/// Writes layers into an existing map file, all or none, also if the process is killed. Throws Error as
/// MapEditor::open.
void write_layers(const std::filesystem::path& map, std::span<const ShapeLayer> layers,
                  MapAccess file = MapAccess::shared);

/// Returns the names of the shape layers of a map, sorted.
std::vector<std::string> shape_layers(const std::filesystem::path& map);

/// Reads a layer. Throws Error{input} if the map has no such layer.
ShapeLayer read_shape_layer(const std::filesystem::path& map, std::string_view name);
/// Calls `begin` with the layer without rows, then `visit` for each row. With `window` (map coordinates),
/// only rows whose boxes intersect it are visited.
void visit_shape_layer(const std::filesystem::path& map, std::string_view name,
                       const std::function<void(const ShapeLayer&)>& begin,
                       const std::function<void(Shape&&)>& visit,
                       const std::optional<MapQuery::Box>& window = {});
/// Returns the number of rows of a layer; 0 if the map has no such layer.
std::int64_t count_shapes(const std::filesystem::path& map, std::string_view name);

}  // namespace waymark::geodb
