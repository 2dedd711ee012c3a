// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/web_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "exporters/report/map_markers.hpp"

namespace waymark::exporters {
namespace {

using StyleJson = nlohmann::ordered_json;

constexpr double kTilePixels = 512;  // of a tile of a vector source at its own zoom
constexpr int kMaxViewZoom = 24;
constexpr int kTintStops = 13;
constexpr const char* kBackground = "#e9e7e2";

std::string hex(const Colour& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue);
}

bool is_outlined(const LandmarkType& type) {
  return solid_name(type) == "bowl";
}

/// Pixels that the body of a landmark measures at each zoom, at least `min`. The width of the world doubles
/// with each zoom, which the interpolation of base 2 follows exactly.
StyleJson body_pixels(double min) {
  StyleJson stops{"interpolate", {"exponential", 2}, {"zoom"}};
  for (int zoom = 0; zoom <= kMaxViewZoom; ++zoom) {
    stops.push_back(zoom);
    stops.push_back({"max", min, {"*", {"coalesce", {"get", "body"}, 0}, std::ldexp(kTilePixels, zoom)}});
  }
  return stops;
}

/// Returns whether the body of a type is drawn as an area, too: the crowns of trees.
bool has_areas(const LandmarkType& type, const WebStyle& about) {
  return std::ranges::any_of(about.shapes, [&](const WebShapeLayer& shapes) {
    return type.body.feature.starts_with(shapes.name + "_");
  });
}

StyleJson circles(const WebLayer& layer, const WebStyle& about) {
  const bool outlined = is_outlined(layer.type);
  const double opacity = outlined ? 0.0 : has_areas(layer.type, about) ? 0.35 : 0.8;
  return {{"id", layer.type.name},
          {"type", "circle"},
          {"source", "landmarks"},
          {"source-layer", layer.type.name},
          {"layout", {{"circle-sort-key", {"-", 0, {"id"}}}}},  // the foremost on top
          {"paint",
           {{"circle-radius", body_pixels(outlined ? 3 : 4)},
            {"circle-pitch-alignment", "map"},
            {"circle-color", layer.type.colour},
            {"circle-opacity", opacity},
            {"circle-stroke-color", outlined ? layer.type.colour : "#ffffff"},
            {"circle-stroke-width", outlined ? 1.8 : 1.0}}}};
}

/// Returns the text of a label: its name, else the label feature in the unit of its format.
StyleJson label_text(const WebLayer& layer) {
  const auto named = std::ranges::count(layer.keys, "name") > 0;
  const auto feature = std::ranges::find(layer.features, layer.type.label_feature, &WebLayer::Feature::name);
  StyleJson text = "";
  if (feature != layer.features.end()) {
    const NumberFormat& format = feature->format;
    const std::string unit = format.unit.empty() ? "" : " " + format.unit;
    StyleJson digits{{"min-fraction-digits", format.decimals}, {"max-fraction-digits", format.decimals}};
    if (format.decimals == 0) digits["locale"] = "fr";  // thousands are parted by thin spaces, as on the page
    const StyleJson number{"number-format", {"*", {"get", feature->name}, format.factor}, digits};
    text = {"case", {"has", feature->name}, {"concat", number, unit}, ""};
  }
  if (!named) return text;
  return {"case", {"!=", {"coalesce", {"get", "name"}, ""}, ""}, {"get", "name"}, text};
}

StyleJson labels(const WebLayer& layer) {
  return {{"id", layer.type.name + "_label"},
          {"type", "symbol"},
          {"source", "landmarks"},
          {"source-layer", layer.type.name},
          {"layout",
           {{"text-field", label_text(layer)},
            {"text-font", {"Noto Sans Regular"}},
            {"text-size", 12},
            {"text-anchor", "left"},
            {"text-offset", {0.8, 0}},
            {"symbol-sort-key", {"id"}}}},
          {"paint", {{"text-color", "#222222"}, {"text-halo-color", "#ffffff"}, {"text-halo-width", 1.4}}}};
}

bool has_labels(const WebLayer& layer) {
  return !layer.type.label_feature.empty() || std::ranges::count(layer.keys, "name") > 0;
}

double web_radius(const WebStyle& about) {
  return about.plane == WebPlane::metres ? kWebRadius : about.crs.body().equatorial_radius;
}

/// Factor of heights for programs that take every body for the Earth, so that slopes are right.
double height_factor(const WebStyle& about) {
  const double factor = kWebRadius / web_radius(about);
  return std::abs(factor - 1) < 0.005 ? 1 : factor;
}

StyleJson terrain_source(const WebStyle& about) {
  StyleJson source{
      {"type", "raster-dem"}, {"url", fmt::format("pmtiles://{}", kTerrainTiles)}, {"tileSize", 256}};
  const double factor = height_factor(about);
  if (factor == 1) {
    source["encoding"] = "terrarium";
  } else {
    source["encoding"] = "custom";  // Terrarium, with heights times the factor
    source["redFactor"] = 256 * factor;
    source["greenFactor"] = factor;
    source["blueFactor"] = factor / 256;
    source["baseShift"] = 32768 * factor;
  }
  return source;
}

StyleJson tint_layer(const WebStyle& about) {
  StyleJson ramp{"interpolate", {"linear"}, {"elevation"}};
  for (int i = 0; i < kTintStops; ++i) {
    const double height = std::lerp(about.tint->lowest, about.tint->highest, double(i) / (kTintStops - 1));
    ramp.push_back(height * height_factor(about));
    ramp.push_back(hex((*about.tint)(height)));
  }
  return {{"id", "terrain_tint"},
          {"type", "color-relief"},
          {"source", "terrain"},
          {"paint", {{"color-relief-color", ramp}}}};
}

/// Everything but the terrain: tiles continue its edges, which would look like terrain.
StyleJson beyond_terrain(const WebStyle& about) {
  const auto position = [](double x, double y) { return StyleJson{web_longitude(x), web_latitude(y)}; };
  // One turn about the terrain's middle: MapLibre lays what is beyond the edges of the world over it.
  const auto [west, east] =
      std::ranges::minmax(about.terrain_outline, {}, [](const auto& at) { return at.x(); });
  const double middle = (west.x() + east.x()) / 2;
  StyleJson world = StyleJson::array();
  for (const auto& [x, y] : {std::pair(-0.5, 1.0), {0.5, 1.0}, {0.5, 0.0}, {-0.5, 0.0}, {-0.5, 1.0}})
    world.push_back(position(middle + x, y));
  StyleJson hole = StyleJson::array();
  for (auto at = about.terrain_outline.rbegin(); at != about.terrain_outline.rend(); ++at)
    hole.push_back(position(at->x(), at->y()));
  hole.push_back(hole.front());
  return {{"type", "geojson"},
          {"data",
           {{"type", "Feature"},
            {"properties", StyleJson::object()},
            {"geometry", {{"type", "Polygon"}, {"coordinates", {world, hole}}}}}}};
}

/// Returns the layers of one layer of polygons: its areas, and its outlines.
StyleJson polygons(const WebShapeLayer& layer) {
  const auto of_kind = [&](const char* suffix, const char* kind, StyleJson paint) {
    return StyleJson{{"id", layer.name + suffix},
                     {"type", kind},
                     {"source", "shapes"},
                     {"source-layer", layer.name},
                     {"paint", paint}};
  };
  return {of_kind("_area", "fill", {{"fill-color", layer.fill}, {"fill-opacity", 0.3}}),
          of_kind("_outline", "line",
                  {{"line-color", layer.colour}, {"line-width", layer.name == "stand" ? 2 : 1}})};
}

/// Returns the title of a column without its unit, which stands behind the value: "Mean height" of
/// mean_height_m.
std::string column_title(const AttributeSpec& column) {
  std::string unit = column.unit == "1/ha" ? "_per_ha" : "_" + column.unit, name = column.name;
  if (const std::size_t slash = unit.find('/'); slash != std::string::npos) unit.replace(slash, 1, "_per_");
  const std::size_t at = column.unit.empty() ? std::string::npos : name.rfind(unit);
  if (at != std::string::npos && (at + unit.size() == name.size() || name[at + unit.size()] == '_'))
    name.erase(at, unit.size());
  return title_of(name);
}

StyleJson shapes_json(const WebStyle& about) {
  StyleJson list = StyleJson::array();
  for (const WebShapeLayer& layer : about.shapes) {
    StyleJson columns = StyleJson::array();
    for (const AttributeSpec& column : layer.columns)
      columns.push_back({{"name", column.name},
                         {"title", column_title(column)},
                         {"unit", column.unit},
                         {"summary", column.summary}});
    list.push_back({{"name", layer.name},
                    {"title", layer.title},
                    {"summary", layer.summary},
                    {"colour", layer.colour},
                    {"fill", layer.fill},
                    {"count", layer.count},
                    {"columns", columns}});
  }
  return list;
}

StyleJson layer_json(const WebLayer& layer) {
  StyleJson features = StyleJson::array();
  for (const WebLayer::Feature& feature : layer.features)
    features.push_back({{"name", feature.name},
                        {"title", feature.title},
                        {"summary", feature.summary},
                        {"unit", feature.format.unit},
                        {"factor", feature.format.factor},
                        {"decimals", feature.format.decimals}});
  StyleJson attributes = StyleJson::array();
  for (const AttributeSpec& one : layer.type.attributes)
    attributes.push_back({{"name", one.name}, {"title", title_of(one.name)}, {"unit", one.unit}});
  return {{"name", layer.type.name},
          {"title", title_of(layer.type.name)},
          {"summary", layer.type.summary},
          {"colour", layer.type.colour},
          {"outlined", is_outlined(layer.type)},
          {"count", layer.count},
          {"features", features},
          {"attributes", attributes}};
}

StyleJson map_json(const WebLandmarks& landmarks, const WebStyle& about) {
  StyleJson types = StyleJson::array();
  for (const WebLayer& layer : landmarks.layers) types.push_back(layer_json(layer));
  const bool local = about.crs.kind() == CrsKind::local;
  const bool plane = about.plane == WebPlane::metres;
  return {{"version", about.version},
          {"crs", about.crs.id()},
          {"crs_name", about.crs.name()},
          {"geographic", about.crs.kind() == CrsKind::geographic},
          {"plane", plane},
          {"body", local ? "" : about.crs.body().name},
          {"radius", web_radius(about)},
          {"flattening", plane ? 0 : about.crs.body().flattening},
          {"metres_per_unit", about.crs.metres_per_unit()},
          {"bounds",
           {web_longitude(about.bounds.west), web_latitude(about.bounds.south),
            web_longitude(about.bounds.east), web_latitude(about.bounds.north)}},
          {"terrain", about.terrain_caption},
          {"height_factor", height_factor(about)},
          {"lowest", about.terrain_lowest},
          {"outside", landmarks.outside},
          {"types", types},
          {"shapes", shapes_json(about)}};
}

}  // namespace

std::string web_style(const WebLandmarks& landmarks, const WebStyle& about) {
  StyleJson style{{"version", 8}, {"name", about.title}};
  style["metadata"] = {{"waymark", map_json(landmarks, about)}};
  style["sources"] = {
      {"landmarks", {{"type", "vector"}, {"url", fmt::format("pmtiles://{}", kLandmarkTiles)}}}};
  StyleJson layers = StyleJson::array();
  layers.push_back(
      {{"id", "background"}, {"type", "background"}, {"paint", {{"background-color", kBackground}}}});
  if (!about.terrain_caption.empty()) {
    style["sources"]["terrain"] = terrain_source(about);
    if (about.tint) layers.push_back(tint_layer(about));
    layers.push_back({{"id", "terrain_shade"},
                      {"type", "hillshade"},
                      {"source", "terrain"},
                      {"paint", {{"hillshade-exaggeration", 0.5}}}});
    style["sources"]["beyond_terrain"] = beyond_terrain(about);
    layers.push_back({{"id", "beyond_terrain"},
                      {"type", "fill"},
                      {"source", "beyond_terrain"},
                      {"paint", {{"fill-color", kBackground}}}});
  }
  if (!about.shapes.empty())
    style["sources"]["shapes"] = {{"type", "vector"}, {"url", fmt::format("pmtiles://{}", kShapeTiles)}};
  for (const WebShapeLayer& shapes : about.shapes)
    for (StyleJson& layer : polygons(shapes)) layers.push_back(std::move(layer));
  for (const WebLayer& layer : landmarks.layers) layers.push_back(circles(layer, about));
  for (const WebLayer& layer : landmarks.layers)
    if (has_labels(layer)) layers.push_back(labels(layer));
  style["layers"] = layers;
  return style.dump(1, ' ', false, StyleJson::error_handler_t::replace) + "\n";
}

std::string landmark_metadata(const WebLandmarks& landmarks, const WebStyle& about, int max_zoom) {
  StyleJson layers = StyleJson::array();
  for (const WebLayer& layer : landmarks.layers) {
    StyleJson fields = StyleJson::object();
    for (const std::string& key : layer.keys)
      fields[key] = key == "uid" || key == "name" ? "String" : "Number";
    layers.push_back({{"id", layer.type.name},
                      {"description", layer.type.summary},
                      {"minzoom", 0},
                      {"maxzoom", max_zoom},
                      {"fields", fields}});
  }
  const StyleJson json{{"name", about.title},
                       {"format", "pbf"},
                       {"generator", "Waymark " + about.version},
                       {"vector_layers", layers}};
  return json.dump(-1, ' ', false, StyleJson::error_handler_t::replace);
}

}  // namespace waymark::exporters
