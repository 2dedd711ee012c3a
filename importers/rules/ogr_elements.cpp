// SPDX-License-Identifier: Apache-2.0
#include <cpl_conv.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cmath>

#include "core/error.hpp"
#include "importers/json_value.hpp"
#include "importers/rules/map_element.hpp"
#include "importers/tables/vector_layer.hpp"

namespace waymark::importers {
namespace {

using Kind = GeometryPart::Kind;

void add_line(const OGRSimpleCurve& line, Kind kind, std::vector<GeometryPart>& parts) {
  GeometryPart part{.kind = kind, .vertices = {}};
  for (int i = 0; i < line.getNumPoints(); ++i)
    part.vertices.emplace_back(line.getX(i), line.getY(i), line.getZ(i));
  const bool ring = kind == Kind::outline || kind == Kind::hole;
  if (ring && part.vertices.size() > 1 && part.vertices.front() == part.vertices.back())
    part.vertices.pop_back();
  if (!part.vertices.empty()) parts.push_back(std::move(part));
}

void add_parts(const OGRGeometry& geometry, std::vector<GeometryPart>& parts) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (geometry.IsEmpty()) return;
  if (type == wkbPoint) {
    const OGRPoint& point = *geometry.toPoint();
    parts.push_back({.kind = Kind::point, .vertices = {{point.getX(), point.getY(), point.getZ()}}});
  } else if (type == wkbLineString) {
    add_line(*geometry.toLineString(), Kind::line, parts);
  } else if (OGR_GT_IsSubClassOf(type, wkbPolygon)) {
    Kind kind = Kind::outline;
    for (const OGRLinearRing* ring : *geometry.toPolygon()) {
      add_line(*ring, kind, parts);
      kind = Kind::hole;
    }
  } else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) {
    for (const OGRGeometry* part : *geometry.toGeometryCollection()) add_parts(*part, parts);
  } else if (OGR_GT_IsSubClassOf(type, wkbPolyhedralSurface)) {
    for (const OGRGeometry* part : *geometry.toPolyhedralSurface()) add_parts(*part, parts);
  }
}

/// Adds the members of a JSON object of texts and numbers, as converters of OSM nest tags in GeoJSON.
void read_tag_object(const std::string& json, const std::string& path,
                     std::map<std::string, std::string>& tags) {
  const JsonValue object = JsonValue::from_text(json, path);
  for (const std::string& name : object.keys()) {
    if (!object.has(name)) continue;
    const JsonValue value = object[name];
    if (value.is_text() && !value.text().empty()) tags[name] = value.text();
    if (value.is_number()) tags[name] = fmt::format("{}", value.number());
  }
}

/// GDAL's OSM driver stores nodes by their ids, unless some are too large: ways then lack these nodes.
class PlainOsmIndex {
 public:
  PlainOsmIndex() { CPLSetThreadLocalConfigOption("OSM_USE_CUSTOM_INDEXING", "NO"); }
  ~PlainOsmIndex() { CPLSetThreadLocalConfigOption("OSM_USE_CUSTOM_INDEXING", nullptr); }
  PlainOsmIndex(PlainOsmIndex&&) = delete;
};

class OgrElements final : public ElementSource {
 public:
  OgrElements(std::string path, const std::string& layer)
      : path_(std::move(path)), layer_(layer), dataset_(open()) {
    if (dataset_->GetDriver() && EQUAL(dataset_->GetDriverName(), "OSM")) choose_index();
    std::vector<std::string> names;
    for (OGRLayer* one : dataset_->GetLayers()) names.emplace_back(one->GetName());
    if (names.empty())
      throw Error(ErrorCode::input, "the file holds no layer", path_, "`ogrinfo` shows its content");
    if (!layer.empty()) layer_named(*dataset_, path_, layer, names);
    for (OGRLayer* one : dataset_->GetLayers())
      if (!crs_ && (layer.empty() || layer == one->GetName())) crs_ = crs_of(*one);
    if (dataset_->GetDriver() && EQUAL(dataset_->GetDriverName(), "DXF")) unit_ = read_dxf_unit(path_);
  }

  std::optional<Crs> crs() const override { return crs_; }
  std::optional<DrawingUnit> unit() const override { return unit_; }

  bool next(MapElement& element) override {
    const GdalListener gdal;
    for (;;) {
      OGRLayer* from = nullptr;
      const OGRFeatureUniquePtr feature(dataset_->GetNextFeature(&from, nullptr, nullptr, nullptr));
      if (!feature) {
        if (const std::string fault = gdal.error_about(path_); !fault.empty())
          throw Error(ErrorCode::input, fmt::format("the file breaks off after feature {}: {}", last_, fault),
                      path_, "fetch or write it again");
        return false;
      }
      last_ = feature->GetFID();
      if (!layer_.empty() && layer_ != from->GetName()) continue;
      element = {
          .layer = from->GetName(), .number = feature->GetFID(), .tags = tags_of(*feature), .parts = {}};
      if (const OGRGeometry* geometry = feature->GetGeometryRef()) {
        const std::unique_ptr<OGRGeometry> linear(geometry->getLinearGeometry());
        add_parts(*linear, element.parts);
      }
      return true;
    }
  }

  void restart() override { dataset_->ResetReading(); }

 private:
  GdalDataset open() const {
    return open_vector(path_, "file", "`ogrinfo --formats` lists what can be read");
  }

  void choose_index() {
    bool too_large = false;
    {
      const GdalListener gdal;
      while (OGRFeatureUniquePtr(dataset_->GetNextFeature(nullptr, nullptr, nullptr, nullptr))) continue;
      too_large = gdal.error_about(path_).find("OSM_USE_CUSTOM_INDEXING") != std::string::npos;
    }
    if (too_large) {
      plain_ = std::make_unique<PlainOsmIndex>();
      dataset_ = open();
    } else {
      dataset_->ResetReading();
    }
  }

  std::map<std::string, std::string> tags_of(OGRFeature& feature) const {
    std::map<std::string, std::string> tags;
    for (int i = 0; i < feature.GetFieldCount(); ++i) {
      if (!feature.IsFieldSetAndNotNull(i)) continue;
      const OGRFieldDefn& field = *feature.GetFieldDefnRef(i);
      const std::string name = field.GetNameRef();
      std::string value = field.GetType() == OFTReal ? fmt::format("{}", feature.GetFieldAsDouble(i))
                                                     : feature.GetFieldAsString(i);
      if (name == "other_tags" || name == "all_tags" ||
          (name == "tags" && value.find("\"=>\"") != value.npos))
        read_hstore(value, tags);
      else if (name == "tags" && value.starts_with('{'))
        read_tag_object(value, path_, tags);
      else if (!value.empty())
        tags[name] = std::move(value);
    }
    if (const char* style = feature.GetStyleString(); style && !tags.contains("style")) tags["style"] = style;
    return tags;
  }

  std::string path_, layer_;
  std::unique_ptr<PlainOsmIndex> plain_;  // for as long as the file is read
  GdalDataset dataset_;
  std::optional<Crs> crs_;
  std::optional<DrawingUnit> unit_;
  std::int64_t last_ = 0;
};

}  // namespace

std::unique_ptr<ElementSource> open_ogr_elements(const std::string& path, const std::string& layer) {
  return std::make_unique<OgrElements>(path, layer);
}

}  // namespace waymark::importers
