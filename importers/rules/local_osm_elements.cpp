// SPDX-License-Identifier: Apache-2.0
// Lanelet2 maps whose nodes have their position in the tags local_x, local_y and ele, in metres.
#include <cpl_conv.h>
#include <cpl_minixml.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "core/error.hpp"
#include "importers/gdal_session.hpp"
#include "importers/rules/map_element.hpp"

namespace waymark::importers {
namespace {

using Kind = GeometryPart::Kind;
using Tags = std::map<std::string, std::string>;

struct FreeXml {
  void operator()(CPLXMLNode* tree) const { CPLDestroyXMLNode(tree); }
};
using Xml = std::unique_ptr<CPLXMLNode, FreeXml>;

Xml read_xml(const std::string& path) {
  const GdalListener gdal;
  Xml tree(CPLParseXMLFile(path.c_str()));
  if (!tree || !CPLGetXMLNode(tree.get(), "=osm"))
    throw Error(ErrorCode::input, "the file is no whole OSM file: " + gdal.error_about(path), path,
                "write it again");
  return tree;
}

Tags tags_of(const CPLXMLNode& object) {
  Tags tags;
  for (const CPLXMLNode* child = object.psChild; child; child = child->psNext)
    if (child->eType == CXT_Element && std::string_view(child->pszValue) == "tag")
      if (const std::string value = CPLGetXMLValue(child, "v", ""); !value.empty())
        tags[CPLGetXMLValue(child, "k", "")] = value;
  return tags;
}

/// Takes a number out of the tags; NaN if there is none.
double take_number(Tags& tags, const char* name) {
  const auto tag = tags.find(name);
  if (tag == tags.end()) return std::nan("");
  const std::string text = tag->second;
  tags.erase(tag);
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return end == text.c_str() ? std::nan("") : number;
}

Eigen::Vector3d take_position(Tags& tags) {
  const double x = take_number(tags, "local_x"), y = take_number(tags, "local_y");
  const double z = take_number(tags, "ele");
  return {x, y, std::isnan(z) ? 0 : z};
}

class LocalOsmElements final : public ElementSource {
 public:
  explicit LocalOsmElements(const std::string& path) {
    const Xml tree = read_xml(path);
    for (const CPLXMLNode* one = CPLGetXMLNode(tree.get(), "=osm")->psChild; one; one = one->psNext)
      if (one->eType == CXT_Element && std::string_view(one->pszValue) == "node") add_node(*one);
    for (const CPLXMLNode* one = CPLGetXMLNode(tree.get(), "=osm")->psChild; one; one = one->psNext)
      if (one->eType == CXT_Element && std::string_view(one->pszValue) == "way") add_way(*one);
    nodes_.clear();
  }

  std::optional<Crs> crs() const override { return Crs::local(); }
  bool next(MapElement& element) override {
    if (at_ >= elements_.size()) return false;
    element = elements_[at_++];
    return true;
  }
  void restart() override { at_ = 0; }

 private:
  void add(const char* layer, const std::string& id, Tags tags, GeometryPart part) {
    if (tags.empty()) return;
    tags["osm_id"] = id;
    elements_.push_back({.layer = layer,
                         .number = std::strtoll(id.c_str(), nullptr, 10),
                         .tags = std::move(tags),
                         .parts = {std::move(part)}});
  }

  void add_node(const CPLXMLNode& node) {
    const std::string id = CPLGetXMLValue(&node, "id", "");
    Tags tags = tags_of(node);
    const Eigen::Vector3d at = take_position(tags);
    tags.erase("mgrs_code");  // of the square in which local_x and local_y count
    nodes_[id] = at;
    add("points", id, std::move(tags), {Kind::point, {at}});
  }

  /// A node that the file lacks has no position, for which the element is rejected.
  void add_way(const CPLXMLNode& way) {
    GeometryPart part{.kind = Kind::line, .vertices = {}};
    for (const CPLXMLNode* child = way.psChild; child; child = child->psNext) {
      if (child->eType != CXT_Element || std::string_view(child->pszValue) != "nd") continue;
      const auto node = nodes_.find(CPLGetXMLValue(child, "ref", ""));
      part.vertices.push_back(node == nodes_.end() ? Eigen::Vector3d::Constant(std::nan("")) : node->second);
    }
    if (part.vertices.empty()) return;
    Tags tags = tags_of(way);
    const auto area = tags.find("area");
    const bool closed = part.vertices.size() > 3 && part.vertices.front() == part.vertices.back();
    if (closed && area != tags.end() && area->second == "yes") {
      part.kind = Kind::outline;
      part.vertices.pop_back();
    }
    add(part.kind == Kind::line ? "lines" : "multipolygons", CPLGetXMLValue(&way, "id", ""), std::move(tags),
        std::move(part));
  }

  std::unordered_map<std::string, Eigen::Vector3d> nodes_;  // of ways, while reading
  std::vector<MapElement> elements_;
  std::size_t at_ = 0;
};

}  // namespace

bool has_geographic_nodes(const std::string& path) {
  const Xml tree = read_xml(path);
  for (const CPLXMLNode* one = CPLGetXMLNode(tree.get(), "=osm")->psChild; one; one = one->psNext) {
    if (one->eType != CXT_Element || std::string_view(one->pszValue) != "node") continue;
    const double lat = std::strtod(CPLGetXMLValue(one, "lat", "0"), nullptr);
    const double lon = std::strtod(CPLGetXMLValue(one, "lon", "0"), nullptr);
    if (lat != 0 || lon != 0) return true;
  }
  return false;
}

std::unique_ptr<ElementSource> open_local_osm_elements(const std::string& path) {
  return std::make_unique<LocalOsmElements>(path);
}

}  // namespace waymark::importers
