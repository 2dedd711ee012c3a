// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/vector_layer.hpp"

namespace waymark::importers {
namespace {

bool has_geometry(OGRLayer& layer) {
  return layer.GetGeomType() != wkbNone;
}

OGRLayer& choose_layer(GDALDataset& dataset, const std::string& path, const std::string& name,
                       const std::string& type) {
  std::vector<std::string> all;
  std::vector<OGRLayer*> with_geometry;
  for (OGRLayer* layer : dataset.GetLayers()) {
    all.emplace_back(layer->GetName());
    if (has_geometry(*layer)) with_geometry.push_back(layer);
  }
  if (all.empty())
    throw Error(ErrorCode::input, "the file holds no layer", path, "`ogrinfo` shows its content");
  for (const std::string& wanted : {name, type})
    if (OGRLayer* layer = wanted.empty() ? nullptr : dataset.GetLayerByName(wanted.c_str())) return *layer;
  if (!name.empty()) return layer_named(dataset, path, name, all);
  if (with_geometry.size() == 1) return *with_geometry[0];
  if (all.size() == 1) return *dataset.GetLayer(0);
  throw Error(ErrorCode::usage, "the file holds several layers", path,
              fmt::format("choose one with --layer: {}", fmt::join(all, ", ")));
}

std::string text(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

class OgrTable final : public TableSource {
 public:
  OgrTable(const std::string& path, const std::string& name, const std::string& type)
      : dataset_(open_vector(path, "file",
                             "pass --from csv for a table of text; `ogrinfo --formats` lists the rest")),
        layer_(&choose_layer(*dataset_, path, name, type)) {
    const GdalListener quiet;
    header_.path = path;
    header_.layer = layer_->GetName();
    header_.row_word = "feature";
    header_.crs = crs_of(*layer_);
    header_.has_points = has_geometry(*layer_);
    OGRFeatureDefn& fields = *layer_->GetLayerDefn();
    for (int i = 0; i < fields.GetFieldCount(); ++i)
      header_.columns.emplace_back(fields.GetFieldDefn(i)->GetNameRef());
    if (header_.has_points)
      for (const char* column : {"geom_x", "geom_y", "geom_z", "geom_area"})
        header_.columns.emplace_back(column);
    layer_->ResetReading();
  }

  const TableHeader& header() const override { return header_; }

  bool next(TableRow& row) override {
    if (broken_) return false;
    const GdalListener gdal;
    const OGRFeatureUniquePtr feature(layer_->GetNextFeature());
    if (!feature) {
      const std::string fault = gdal.error_about(header_.path);
      if (fault.empty()) return false;
      broken_ = true;
      throw Error(ErrorCode::input,
                  fmt::format("the layer breaks off after feature {}: {}", row.number, fault), header_.path,
                  "fetch or write it again");
    }
    row.number = feature->GetFID();
    row.cells.clear();
    for (int i = 0; i < feature->GetFieldCount(); ++i) row.cells.push_back(cell(*feature, i));
    if (header_.has_points) add_geometry(row, *feature);
    return true;
  }

 private:
  static std::string cell(OGRFeature& feature, int field) {
    if (!feature.IsFieldSetAndNotNull(field)) return {};
    if (feature.GetFieldDefnRef(field)->GetType() == OFTReal) return text(feature.GetFieldAsDouble(field));
    return feature.GetFieldAsString(field);
  }

  static void add_geometry(TableRow& row, OGRFeature& feature) {
    const OGRGeometry* geometry = feature.GetGeometryRef();
    OGRPoint point;
    double area = std::nan("");
    bool found = false;
    if (geometry != nullptr && !geometry->IsEmpty()) {
      const OGRwkbGeometryType kind = wkbFlatten(geometry->getGeometryType());
      if (kind == wkbPoint) {
        point = *geometry->toPoint();
        found = true;
      } else {
        found = geometry->Centroid(&point) == OGRERR_NONE;
        if (const auto* surface = dynamic_cast<const OGRSurface*>(geometry)) area = surface->get_Area();
        if (const auto* parts = dynamic_cast<const OGRMultiSurface*>(geometry)) area = parts->get_Area();
      }
    }
    const bool high = found && point.Is3D();
    for (const double value : {found ? point.getX() : std::nan(""), found ? point.getY() : std::nan(""),
                               high ? point.getZ() : std::nan(""), area})
      row.cells.push_back(text(value));
  }

  TableHeader header_;
  GdalDataset dataset_;
  OGRLayer* layer_;
  bool broken_ = false;  // rows after a fault are not read
};

}  // namespace

std::unique_ptr<TableSource> open_ogr_table(const std::string& path, const std::string& layer,
                                            const std::string& type) {
  return std::make_unique<OgrTable>(path, layer, type);
}

}  // namespace waymark::importers
