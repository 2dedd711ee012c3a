// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/web_shapes.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "exporters/formatting.hpp"
#include "exporters/web/gzip.hpp"
#include "exporters/web/vector_tile.hpp"
#include "exporters/web/web_landmarks.hpp"
#include "geodb/shape_layer.hpp"

namespace waymark::exporters {
namespace {

constexpr double kExtent = VectorLayer::kExtent;
constexpr double kBuffer = 64;      // steps beyond the edges of a tile
constexpr double kMinSize = 32;     // steps: 4 pixels of a tile of 512
constexpr double kMinDistance = 4;  // steps: half a pixel

struct Look {
  const char *layer, *colour, *fill;
};
// Stands lie below crowns. The colours are those of the layers in QGIS.
constexpr std::array<Look, 2> kLooks{{{"stand", "#5d4037", "#a5d6a7"}, {"crown", "#1b5e20", "#66bb6a"}}};

/// Columns of stands by classes of diameter, "stems_per_ha_d005", are too many for a popup.
bool is_class(const std::string& column) {
  const std::size_t at = column.rfind("_d");
  return at != std::string::npos && at + 2 < column.size() &&
         std::isdigit(static_cast<unsigned char>(column[at + 2])) != 0;
}

/// Returns a ring on the world, in one piece across its edge; empty if a vertex is beyond the world.
std::vector<Eigen::Vector2d> on_world(const std::vector<Eigen::Vector2d>& ring,
                                      const WebProjection& projection, std::optional<double>& near_x) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector2d& vertex : ring) {
    auto at = projection.to_world(vertex.x(), vertex.y());
    if (!at) return {};
    if (near_x) at->x() += std::round(*near_x - at->x());
    near_x = at->x();
    points.push_back(*at);
  }
  if (points.size() > 1 && points.front() == points.back()) points.pop_back();
  return points;
}

/// Returns the polygon of a row; without rings if it is beyond the world.
WebShape shape_on_world(const geodb::Shape& row, const WebProjection& projection) {
  WebShape shape;
  std::optional<double> near_x;
  const auto add = [&](const std::vector<Eigen::Vector2d>& ring, bool is_hole) {
    shape.rings.push_back({on_world(ring, projection, near_x), is_hole});
    for (const Eigen::Vector2d& point : shape.rings.back().points) shape.box.extend(point);
    return shape.rings.back().points.size() > 2;
  };
  for (const geodb::ShapePart& part : row.parts) {
    bool is_whole = add(part.outer, false);
    for (const auto& hole : part.holes) is_whole = add(hole, true) && is_whole;
    if (!is_whole) return {};
  }
  return shape;
}

// Sutherland-Hodgman: cuts a ring at the line where `axis` is `limit`, and keeps the side below (sign 1) or
// above (-1).
std::vector<Eigen::Vector2d> cut(const std::vector<Eigen::Vector2d>& ring, int axis, double limit,
                                 double sign) {
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i == 0 ? ring.size() - 1 : i - 1], &b = ring[i];
    const double from = sign * (a[axis] - limit), to = sign * (b[axis] - limit);
    if ((from < 0) != (to < 0)) kept.emplace_back(a + (b - a) * (from / (from - to)));
    if (to <= 0) kept.push_back(b);
  }
  return kept;
}

double twice_area(const std::vector<std::array<std::int32_t, 2>>& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
    sum += double(a[0]) * double(b[1]) - double(b[0]) * double(a[1]);
  }
  return sum;
}

/// Returns a ring in steps from the corner of a tile; the same vertices for all tiles of the zoom.
std::vector<Eigen::Vector2d> in_steps(const WebShape::Ring& ring, double scale, const Eigen::Vector2d& corner,
                                      double min_distance) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector2d& point : ring.points) {
    const Eigen::Vector2d step = (point * scale).array().round() - corner.array();
    if (points.empty() || (step - points.back()).norm() > min_distance) points.push_back(step);
  }
  return points;
}

/// Returns the part of a ring in the square of a tile with its buffer, turned as vector tiles have it; empty
/// if nothing is left.
TilePolygon::Ring clipped(std::vector<Eigen::Vector2d> ring, bool is_hole) {
  for (int axis = 0; axis < 2; ++axis) {
    ring = cut(ring, axis, kExtent + kBuffer, 1);
    ring = cut(ring, axis, -kBuffer, -1);
  }
  TilePolygon::Ring result;
  for (const Eigen::Vector2d& point : ring) {
    const std::array<std::int32_t, 2> step{static_cast<std::int32_t>(std::lround(point.x())),
                                           static_cast<std::int32_t>(std::lround(point.y()))};
    if (result.empty() || step != result.back()) result.push_back(step);
  }
  while (result.size() > 1 && result.front() == result.back()) result.pop_back();
  const double area = twice_area(result);
  if (area == 0) return {};
  if ((area < 0) != is_hole) std::ranges::reverse(result);
  return result;
}

}  // namespace

WebShapes read_web_shapes(const std::filesystem::path& map, const WebProjection& projection) {
  WebShapes all;
  const std::vector<std::string> there = geodb::shape_layers(map);
  for (const Look& look : kLooks) {
    if (std::ranges::find(there, look.layer) == there.end()) continue;
    WebShapeLayer layer{
        .name = look.layer, .title = {}, .summary = {}, .colour = look.colour, .fill = look.fill};
    std::vector<std::size_t> shown;  // columns
    bool is_polygons = false;
    geodb::visit_shape_layer(
        map, look.layer,
        [&](const geodb::ShapeLayer& declared) {
          is_polygons = declared.kind == geodb::ShapeKind::polygon;
          layer.summary = declared.summary;
          layer.title = title_of(layer.name);
          for (std::size_t i = 0; i < declared.columns.size(); ++i) {
            if (is_class(declared.columns[i].name)) continue;
            shown.push_back(i);
            layer.columns.push_back(declared.columns[i]);
            layer.keys.push_back(declared.columns[i].name);
          }
        },
        [&](geodb::Shape&& row) {
          if (!is_polygons || row.parts.empty()) return;
          WebShape shape = shape_on_world(row, projection);
          if (shape.rings.empty()) {
            ++all.outside;
            return;
          }
          shape.layer = static_cast<std::uint32_t>(all.layers.size());
          shape.first = all.properties.size();
          for (std::size_t key = 0; key < shown.size(); ++key)
            append_property(all.properties, static_cast<std::uint32_t>(key), row.values[shown[key]]);
          shape.size = static_cast<std::uint32_t>(all.properties.size() - shape.first);
          ++layer.count;
          all.shapes.push_back(std::move(shape));
        });
    if (layer.count > 0) all.layers.push_back(std::move(layer));
  }
  return all;
}

WebBounds bounds_of(const WebShapes& shapes) {
  if (shapes.shapes.empty()) return {};
  Eigen::AlignedBox2d box, across;  // as they lie, and with the west behind the east
  for (const WebShape& shape : shapes.shapes) {
    const Eigen::Vector2d turn(shape.box.min().x() < 0.5 ? 1 : 0, 0);
    box.extend(shape.box);
    across.extend(Eigen::AlignedBox2d(shape.box.min() + turn, shape.box.max() + turn));
  }
  if (across.sizes().x() < box.sizes().x()) box = across;
  return {box.min().x(), box.min().y(), box.max().x(), box.max().y()};
}

int top_zoom(const WebShapes& shapes, double world_width) {
  const WebBounds bounds = bounds_of(shapes);
  const double extent = std::max(bounds.east - bounds.west, bounds.south - bounds.north);
  const double max_step = std::max(0.05 / world_width, 1e-5 * extent);
  int zoom = 0;
  while (zoom < kMaxWebZoom && std::ldexp(1 / kExtent, -zoom) > max_step) ++zoom;
  return zoom;
}

std::vector<ShapeTile> shape_tiles(const WebShapes& all, int zoom, int top) {
  const auto per_side = std::int64_t{1} << zoom;
  const auto tiles_of_range = [&](double from, double to) {
    const double margin = kBuffer / kExtent;
    return std::pair(static_cast<std::int64_t>(std::floor(from * double(per_side) - margin)),
                     static_cast<std::int64_t>(std::floor(to * double(per_side) + margin)));
  };
  std::map<std::uint64_t, ShapeTile> tiles;
  for (std::size_t i = 0; i < all.shapes.size(); ++i) {
    const Eigen::AlignedBox2d& box = all.shapes[i].box;
    if (zoom < top && box.sizes().maxCoeff() * kExtent * double(per_side) < kMinSize) continue;
    const auto [west, east] = tiles_of_range(box.min().x(), box.max().x());
    const auto [north, south] = tiles_of_range(box.min().y(), box.max().y());
    for (std::int64_t row = std::max<std::int64_t>(north, 0); row <= std::min(south, per_side - 1); ++row)
      for (std::int64_t column = west; column <= std::min(east, west + per_side - 1); ++column) {
        const TileId id{zoom, static_cast<std::uint32_t>((column % per_side + per_side) % per_side),
                        static_cast<std::uint32_t>(row)};
        ShapeTile& tile = tiles.try_emplace(pmtiles_id(id), ShapeTile{id}).first->second;
        if (tile.shapes.empty() || tile.shapes.back() != i)
          tile.shapes.push_back(static_cast<std::uint32_t>(i));
      }
  }
  std::vector<ShapeTile> list;
  for (auto& [id, tile] : tiles) list.push_back(std::move(tile));
  return list;
}

std::string shape_tile(const WebShapes& all, const ShapeTile& tile, int top) {
  std::vector<VectorLayer> layers;
  for (const WebShapeLayer& layer : all.layers) layers.push_back({.name = layer.name, .keys = layer.keys});
  const double per_side = std::ldexp(1, tile.id.zoom), scale = kExtent * per_side;
  const double min_distance = tile.id.zoom < top ? kMinDistance : 0;
  for (const std::uint32_t number : tile.shapes) {
    const WebShape& shape = all.shapes[number];
    TilePolygon polygon{.id = number + std::uint64_t{1}};
    polygon.properties.push_back(std::string_view(all.properties).substr(shape.first, shape.size));
    // A polygon across the edge of the world may reach into the tile from either side.
    for (double turn = std::floor(shape.box.min().x()); turn <= std::floor(shape.box.max().x()); ++turn) {
      const Eigen::Vector2d corner((tile.id.column + turn * per_side) * kExtent, tile.id.row * kExtent);
      bool has_outer = false;
      for (const WebShape::Ring& ring : shape.rings) {
        if (ring.is_hole && !has_outer) continue;
        TilePolygon::Ring part = clipped(in_steps(ring, scale, corner, min_distance), ring.is_hole);
        if (!ring.is_hole) has_outer = part.size() > 2;
        if (part.size() > 2) polygon.rings.push_back(std::move(part));
      }
    }
    if (!polygon.rings.empty()) layers[shape.layer].polygons.push_back(std::move(polygon));
  }
  return gzip(encode_vector_tile(layers));
}

std::string shape_metadata(const WebShapes& all, const std::string& title, int top) {
  auto layers = nlohmann::ordered_json::array();
  for (const WebShapeLayer& layer : all.layers) {
    auto fields = nlohmann::ordered_json::object();
    for (const AttributeSpec& column : layer.columns)
      fields[column.name] = column.kind == AttributeSpec::Kind::text ? "String" : "Number";
    layers.push_back({{"id", layer.name},
                      {"description", layer.summary},
                      {"minzoom", 0},
                      {"maxzoom", top},
                      {"fields", fields}});
  }
  const nlohmann::ordered_json json{{"name", title}, {"format", "pbf"}, {"vector_layers", layers}};
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace waymark::exporters
