// SPDX-License-Identifier: Apache-2.0
// CityJSON 1.0 to 2.0 (cityjson.org/specs): objects with attributes and geometries of indexed vertices.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/error.hpp"
#include "importers/json_value.hpp"
#include "importers/rules/map_element.hpp"

namespace waymark::importers {
namespace {

using Kind = GeometryPart::Kind;
constexpr int kMaxDepth = 8;   // of parts of parts
constexpr double kFlat = 0.1;  // m; vertices of a ground surface lie within this of the lowest

struct Surface {
  std::vector<std::vector<Eigen::Vector3d>> rings;
  bool ground = false;  // by its semantics
};

std::string text_of(const JsonValue& value) {
  if (value.is_text()) return value.text();
  return value.is_number() ? fmt::format("{}", value.number()) : "";
}

double lowest(const Surface& surface) {
  double z = std::numeric_limits<double>::infinity();
  for (const auto& ring : surface.rings)
    for (const Eigen::Vector3d& v : ring) z = std::min(z, v.z());
  return z;
}

bool is_flat(const Surface& surface) {
  const double low = lowest(surface);
  return std::ranges::all_of(surface.rings, [&](const auto& ring) {
    return std::ranges::all_of(ring, [&](const Eigen::Vector3d& v) { return v.z() <= low + kFlat; });
  });
}

class CityJsonElements final : public ElementSource {
 public:
  explicit CityJsonElements(const std::string& path) : root_(JsonValue::from_file(path)) {
    for (const char* needed : {"CityObjects", "vertices"})
      if (!root_.has(needed))
        throw Error(ErrorCode::input, fmt::format("the CityJSON file has no '{}'", needed), path,
                    "write it again; CityJSONSeq (one object a line) is not read");
    objects_ = root_["CityObjects"].keys();
    if (root_.has("transform")) {
      scale_ = root_["transform"]["scale"].vector3();
      shift_ = root_["transform"]["translate"].vector3();
    }
    const JsonValue vertices = root_["vertices"];
    for (std::size_t i = 0; i < vertices.size(); ++i)
      vertices_.push_back(vertices[i].vector3().cwiseProduct(scale_) + shift_);
  }

  std::optional<Crs> crs() const override {
    if (!root_.has("metadata") || !root_["metadata"].has("referenceSystem")) return {};
    std::string name = root_["metadata"]["referenceSystem"].text();  // .../EPSG/0/7415 or urn:...:EPSG::7415
    const std::size_t digits = name.find_last_not_of("0123456789");
    return Crs::from_text("EPSG:" + name.substr(digits == std::string::npos ? 0 : digits + 1));
  }

  bool next(MapElement& element) override {
    if (at_ >= objects_.size()) return false;
    const std::string& id = objects_[at_];
    const JsonValue object = root_["CityObjects"][id];
    element = {.layer = object["type"].text(), .number = std::int64_t(++at_), .tags = {}, .parts = {}};
    if (object.has("attributes"))
      for (const std::string& name : object["attributes"].keys())
        if (object["attributes"].has(name))
          if (std::string value = text_of(object["attributes"][name]); !value.empty())
            element.tags[name] = std::move(value);
    element.tags["id"] = id;  // win over attributes of these names
    element.tags["type"] = element.layer;
    if (object.has("geometry")) add_geometry(object["geometry"], element.parts);
    if (element.layer == "Building") add_building_parts(object, element);
    return true;
  }

  void restart() override { at_ = 0; }

 private:
  /// Parts of a building with their own geometry, and what the building takes of them.
  struct BuildingParts {
    int count = 0;
    std::vector<GeometryPart> ground;
    double height = 0;  ///< largest measuredHeight, m; 0: none has one
  };

  void collect_parts(const JsonValue& object, int depth, BuildingParts& parts) const {
    if (!object.has("children") || depth > kMaxDepth) return;
    for (std::size_t i = 0; i < object["children"].size(); ++i) {
      const std::string id = object["children"][i].text();
      if (!root_["CityObjects"].has(id)) continue;
      const JsonValue child = root_["CityObjects"][id];
      if (child["type"].text() != "BuildingPart") continue;
      std::vector<GeometryPart> ground;
      if (child.has("geometry")) add_geometry(child["geometry"], ground);
      parts.count += !ground.empty();
      parts.ground.insert(parts.ground.end(), ground.begin(), ground.end());
      if (child.has("attributes") && child["attributes"].has("measuredHeight") &&
          child["attributes"]["measuredHeight"].is_number())
        parts.height = std::max(parts.height, child["attributes"]["measuredHeight"].number());
      collect_parts(child, depth + 1, parts);
    }
  }

  /// A building with parts has the tag `parts`, their number, and takes from them what it lacks itself: its
  /// ground and its height.
  void add_building_parts(const JsonValue& object, MapElement& element) const {
    BuildingParts parts;
    collect_parts(object, 0, parts);
    if (parts.count == 0) return;
    element.tags["parts"] = std::to_string(parts.count);
    if (element.parts.empty()) element.parts = std::move(parts.ground);
    if (parts.height > 0 && !element.tags.contains("measuredHeight"))
      element.tags["measuredHeight"] = fmt::format("{}", parts.height);
  }

  Eigen::Vector3d vertex(const JsonValue& index) const {
    const std::int64_t i = index.integer();
    if (i < 0 || i >= std::int64_t(vertices_.size()))
      index.refuse(fmt::format("there is no vertex {}", i), fmt::format("the file has {}", vertices_.size()));
    return vertices_[std::size_t(i)];
  }

  std::vector<Eigen::Vector3d> vertices_of(const JsonValue& list) const {
    std::vector<Eigen::Vector3d> all;
    for (std::size_t i = 0; i < list.size(); ++i) all.push_back(vertex(list[i]));
    return all;
  }

  /// A surface is a list of rings, which are lists of numbers; shells and solids are lists of surfaces.
  void collect(const JsonValue& boundaries, std::vector<Surface>& surfaces) const {
    for (std::size_t i = 0; i < boundaries.size(); ++i) {
      const JsonValue one = boundaries[i];
      const bool is_surface = one.size() > 0 && one[std::size_t(0)].is_array() &&
                              one[std::size_t(0)].size() > 0 &&
                              one[std::size_t(0)][std::size_t(0)].is_number();
      if (!is_surface) {
        if (one.size() > 0 && one[std::size_t(0)].is_array()) collect(one, surfaces);
        continue;
      }
      Surface& surface = surfaces.emplace_back();
      for (std::size_t ring = 0; ring < one.size(); ++ring) surface.rings.push_back(vertices_of(one[ring]));
    }
  }

  /// Marks the surfaces that the semantics call GroundSurface; `values` nest as the boundaries do.
  static void mark_ground(const JsonValue& kinds, const JsonValue& values, std::vector<Surface>& surfaces,
                          std::size_t& at) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const JsonValue one = values[i];
      if (one.is_array()) {
        mark_ground(kinds, one, surfaces, at);
        continue;
      }
      if (at < surfaces.size() && one.is_number() && std::size_t(one.integer()) < kinds.size())
        surfaces[at].ground = kinds[std::size_t(one.integer())]["type"].text() == "GroundSurface";
      ++at;
    }
  }

  void add_geometry(const JsonValue& geometries, std::vector<GeometryPart>& parts) const {
    std::optional<std::size_t> coarsest;
    for (std::size_t i = 0; i < geometries.size(); ++i)
      if (geometries[i].has("boundaries") && (!coarsest || lod(geometries[i]) < lod(geometries[*coarsest])))
        coarsest = i;
    if (!coarsest) return;
    const JsonValue geometry = geometries[*coarsest], boundaries = geometry["boundaries"];
    const std::string type = geometry["type"].text();
    if (type == "MultiPoint" || type == "GeometryInstance") {  // an instance has its point of reference
      for (const Eigen::Vector3d& v : vertices_of(boundaries)) parts.push_back({Kind::point, {v}});
    } else if (type == "MultiLineString") {
      for (std::size_t i = 0; i < boundaries.size(); ++i)
        parts.push_back({Kind::line, vertices_of(boundaries[i])});
    } else {
      std::vector<Surface> surfaces;
      collect(boundaries, surfaces);
      if (geometry.has("semantics") && geometry["semantics"].has("values")) {
        std::size_t at = 0;
        mark_ground(geometry["semantics"]["surfaces"], geometry["semantics"]["values"], surfaces, at);
      }
      add_ground(surfaces, parts);
    }
  }

  static double lod(const JsonValue& geometry) {
    return geometry.has("lod") ? std::strtod(text_of(geometry["lod"]).c_str(), nullptr) : 0;
  }

  static void add_ground(const std::vector<Surface>& surfaces, std::vector<GeometryPart>& parts) {
    const bool named = std::ranges::any_of(surfaces, &Surface::ground);
    double low = std::numeric_limits<double>::infinity();
    for (const Surface& surface : surfaces) low = std::min(low, lowest(surface));
    for (const Surface& surface : surfaces) {
      if (named ? !surface.ground : !is_flat(surface) || lowest(surface) > low + kFlat) continue;
      for (std::size_t i = 0; i < surface.rings.size(); ++i)
        parts.push_back({i == 0 ? Kind::outline : Kind::hole, surface.rings[i]});
    }
  }

  JsonValue root_;
  std::vector<std::string> objects_;
  std::vector<Eigen::Vector3d> vertices_;
  Eigen::Vector3d scale_ = Eigen::Vector3d::Ones(), shift_ = Eigen::Vector3d::Zero();
  std::size_t at_ = 0;
};

}  // namespace

std::unique_ptr<ElementSource> open_cityjson_elements(const std::string& path) {
  return std::make_unique<CityJsonElements>(path);
}

}  // namespace waymark::importers
