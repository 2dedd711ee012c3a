// SPDX-License-Identifier: Apache-2.0
#include <cpl_csv.h>
#include <cpl_minixml.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

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

/// Fields that are empty in a delimited table of PDS4: GDAL reads their numbers as 0.
class EmptyFields {
 public:
  EmptyFields(GDALDataset& dataset, OGRLayer& layer, const std::string& path) {
    if (!EQUAL(dataset.GetDriverName(), "PDS4")) return;
    const std::unique_ptr<CPLXMLNode, void (*)(CPLXMLNode*)> label(CPLParseXMLFile(path.c_str()),
                                                                   CPLDestroyXMLNode);
    if (!label) return;
    CPLStripXMLNamespace(label.get(), nullptr, TRUE);
    CPLXMLNode* product = CPLSearchXMLNode(label.get(), "=Product_Observational");
    for (CPLXMLNode* area = product != nullptr ? product->psChild : nullptr; area; area = area->psNext)
      if (EQUAL(area->pszValue, "File_Area_Observational"))
        for (CPLXMLNode* table = area->psChild; table; table = table->psNext)
          if (EQUAL(table->pszValue, "Table_Delimited") &&
              EQUAL(CPLGetXMLValue(table, "local_identifier", ""), layer.GetName()))
            open(*area, *table, *layer.GetLayerDefn(), path);
  }

  /// Reads the next record. `fields` of the layer have no value in it.
  std::vector<int> next() {
    std::vector<int> fields;
    if (!file_) return fields;
    const CPLStringList record(CSVReadParseLine2L(file_.get(), delimiter_));
    for (int i = 0; i < record.size() && i < static_cast<int>(field_of_.size()); ++i)
      if (field_of_[static_cast<std::size_t>(i)] >= 0 && *record[i] == '\0')
        fields.push_back(field_of_[static_cast<std::size_t>(i)]);
    return fields;
  }

 private:
  void open(CPLXMLNode& area, CPLXMLNode& table, OGRFeatureDefn& fields, const std::string& path) {
    const std::string separator = CPLGetXMLValue(&table, "field_delimiter", "");
    delimiter_ = EQUAL(separator.c_str(), "Horizontal Tab") ? '\t'
                 : EQUAL(separator.c_str(), "Semicolon")    ? ';'
                 : EQUAL(separator.c_str(), "Vertical Bar") ? '|'
                                                            : ',';
    CPLXMLNode* record = CPLGetXMLNode(&table, "Record_Delimited");
    for (CPLXMLNode* field = record != nullptr ? record->psChild : nullptr; field; field = field->psNext)
      if (EQUAL(field->pszValue, "Field_Delimited"))
        field_of_.push_back(fields.GetFieldIndex(CPLGetXMLValue(field, "name", "")));
    const std::string name =
        CPLFormFilename(CPLGetPath(path.c_str()), CPLGetXMLValue(&area, "File.file_name", ""), nullptr);
    file_.reset(VSIFOpenL(name.c_str(), "rb"));
    if (file_)
      VSIFSeekL(file_.get(), std::strtoull(CPLGetXMLValue(&table, "offset", "0"), nullptr, 10), SEEK_SET);
  }

  std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file_{nullptr, VSIFCloseL};
  char delimiter_ = ',';
  std::vector<int> field_of_;  // of the layer; -1: a coordinate
};

class OgrTable final : public TableSource {
 public:
  OgrTable(const std::string& path, const std::string& name, const std::string& type)
      : dataset_(open_vector(path, "file",
                             "pass --from csv for a table of text; `ogrinfo --formats` lists the rest")),
        layer_(&choose_layer(*dataset_, path, name, type)),
        empty_(*dataset_, *layer_, path) {
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
    for (const int field : empty_.next()) feature->SetFieldNull(field);
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
  EmptyFields empty_;
  bool broken_ = false;  // rows after a fault are not read
};

}  // namespace

std::unique_ptr<TableSource> open_ogr_table(const std::string& path, const std::string& layer,
                                            const std::string& type) {
  return std::make_unique<OgrTable>(path, layer, type);
}

}  // namespace waymark::importers
