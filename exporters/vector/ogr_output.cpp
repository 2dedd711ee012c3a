// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/ogr_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/output_error.hpp"
#include "exporters/formatting.hpp"
#include "exporters/gdal_messages.hpp"
#include "exporters/vector/checked_writes.hpp"
#include "exporters/vector/export_columns.hpp"
#include "exporters/vector/placemark_text.hpp"

namespace waymark::exporters {
namespace {

/// A column and the field it is written to.
struct Field {
  ExportColumn column;
  int index = 0;
};

/// Returns whether a column has integers that need 64 bits: many formats lack them or store them as text.
bool has_wide_integers(const ExportColumn& column, const LandmarkType& type,
                       const LandmarkStream& landmarks) {
  const auto attribute = std::ranges::find(type.attributes, column.name, &AttributeSpec::name);
  if (column.kind != AttributeSpec::Kind::integer || attribute == type.attributes.end())
    return false;  // counts are int
  bool wide = false;
  landmarks([&](const Landmark& landmark) {
    const AttributeValue value = column.value(landmark);
    const auto* integer = std::get_if<std::int64_t>(&value);
    wide = wide || (integer != nullptr && *integer != static_cast<std::int32_t>(*integer));
  });
  return wide;
}

OGRFieldType field_type(const ExportColumn& column, const LandmarkType& type,
                        const LandmarkStream& landmarks) {
  if (column.kind == AttributeSpec::Kind::real) return OFTReal;
  if (column.kind == AttributeSpec::Kind::text) return OFTString;
  return has_wide_integers(column, type, landmarks) ? OFTInteger64 : OFTInteger;
}

ExportColumn coordinate(const char* name, Eigen::Index axis) {
  return {name, "", "Position", AttributeSpec::Kind::real,
          [axis](const Landmark& l) { return AttributeValue(l.position.xyz[axis]); }};
}

ExportColumn text(const std::string& name, std::function<std::string(const Landmark&)> of) {
  return {name, "", "", AttributeSpec::Kind::text, [of](const Landmark& l) { return AttributeValue(of(l)); }};
}

std::vector<ExportColumn> columns_of(const VectorFormat& format, const LandmarkType& type) {
  std::vector<ExportColumn> columns = export_columns(type);
  if (format.is_table)
    columns.insert(columns.begin() + 1, {coordinate("x", 0), coordinate("y", 1), coordinate("z", 2)});
  if (!format.name_field.empty()) {
    std::erase_if(columns,
                  [](const ExportColumn& column) { return column.name == "name"; });  // in name_field
    columns.insert(columns.begin(),
                   {text(format.name_field, [&type](const Landmark& l) { return placemark_name(l, type); }),
                    text(format.description_field,
                         [&type](const Landmark& l) { return placemark_description(l, type); })});
  }
  return columns;
}

CPLStringList layer_options(const VectorFormat& format, const Crs& crs) {
  CPLStringList options;
  if (format.driver == "GeoJSON") {
    if (crs.same_as(Crs::from_text("EPSG:4326"))) options.SetNameValue("RFC7946", "YES");
    options.SetNameValue("ID_FIELD", "uid");
    options.SetNameValue("SIGNIFICANT_FIGURES", "12");
  }
  if (format.driver == "CSV")
    options.SetNameValue("STRING_QUOTING", "IF_NEEDED");  // otherwise integers are quoted
  if (!format.has_index) options.SetNameValue("SPATIAL_INDEX", "NO");
  if (format.driver == "ESRI Shapefile") options.SetNameValue("ENCODING", "UTF-8");
  // Undefined and Cartesian, for SpatiaLite; by default GDAL writes 0, undefined degrees.
  if (format.driver == "SQLite" && crs.kind() == CrsKind::local) options.SetNameValue("SRID", "-1");
  return options;
}

CPLStringList file_options(const VectorFormat& format) {
  CPLStringList options;
  if (format.driver == "GPX") options.SetNameValue("GPX_USE_EXTENSIONS", "YES");
  if (format.driver == "GeoRSS") options.SetNameValue("USE_EXTENSIONS", "YES");
  for (const std::string& option : format.creation_options) options.AddString(option.c_str());
  return options;
}

struct ReleaseSrs {
  void operator()(OGRSpatialReference* srs) const { srs->Release(); }
};
using Srs = std::unique_ptr<OGRSpatialReference, ReleaseSrs>;

/// Returns null for a local CRS: metres on no body.
Srs srs_of(const Crs& crs) {
  if (crs.kind() == CrsKind::local) return {};
  Srs srs(new OGRSpatialReference);
  srs->importFromWkt(crs.wkt2().c_str());
  srs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return srs;
}

void set_field(OGRFeature& feature, int index, const AttributeValue& value, bool is_table) {
  if (const auto* real = std::get_if<double>(&value)) feature.SetField(index, *real);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) feature.SetField(index, GIntBig{*integer});
  if (const auto* words = std::get_if<std::string>(&value))
    feature.SetField(index, (is_table ? spreadsheet_text(*words) : *words).c_str());
  if (std::holds_alternative<std::monostate>(value)) feature.SetFieldNull(index);
}

}  // namespace

struct OgrOutput::File {
  VectorFormat format;
  std::string output_name;
  GdalMessages messages;
  std::unique_ptr<GDALDataset> dataset;
  std::vector<std::string> warnings;
  std::int64_t failed_before = failed_writes();

  [[noreturn]] void fail(const std::string& otherwise) {
    fail_output(output_name, messages.cause(otherwise),
                "if the folder can be written to, the format is at fault: try .gpkg, .geojson or .csv");
  }

  std::vector<Field> add_fields(OGRLayer& layer, const LandmarkType& type, const LandmarkStream& landmarks) {
    std::vector<std::string> names, refused, shortened;
    const auto columns = columns_of(format, type);
    for (const ExportColumn& column : columns) names.push_back(column.name);
    const auto fitting = shorten_names(format, names);
    std::vector<Field> fields;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const GdalMessages quiet;  // columns that a format lacks give a warning below
      OGRFieldDefn definition(fitting[i].c_str(), field_type(columns[i], type, landmarks));
      int index = layer.GetLayerDefn()->GetFieldIndex(fitting[i].c_str());
      if (index < 0 && layer.CreateField(&definition) == OGRERR_NONE)
        index = layer.GetLayerDefn()->GetFieldIndex(fitting[i].c_str());
      if (index >= 0) fields.push_back({columns[i], index});
      if (index < 0) refused.push_back(names[i]);
      if (fitting[i] != names[i]) shortened.push_back(names[i] + " as " + fitting[i]);
    }
    if (!refused.empty())
      warnings.push_back(fmt::format("{} cannot store: {}", format.driver, fmt::join(refused, ", ")));
    if (!shortened.empty())
      warnings.push_back(
          fmt::format("{} has short column names: {}", format.driver, fmt::join(shortened, ", ")));
    return fields;
  }
};

OgrOutput::OgrOutput(const VectorFormat& format, const std::string& path, std::string output_name)
    : file_(std::make_unique<File>()) {
  file_->format = format;
  file_->output_name = std::move(output_name);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(format.driver.c_str());
  CPLStringList options = file_options(format);
  const std::string name = format.reports_writes ? path : with_checked_writes(path);
  file_->dataset.reset(format.is_file ? driver->Create(name.c_str(), 0, 0, 0, GDT_Unknown, options.List())
                                      : GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE,
                                                          nullptr, nullptr, nullptr));
  if (!file_->dataset) file_->fail(format.driver + " could not create it");
}

OgrOutput::~OgrOutput() = default;

void OgrOutput::add_layer(const LandmarkType& type, const LandmarkStream& landmarks, const Crs& crs) {
  File& file = *file_;
  const Srs srs = file.format.is_table ? Srs() : srs_of(crs);
  CPLStringList options = layer_options(file.format, crs);
  OGRLayer* layer = file.dataset->CreateLayer(type.name.c_str(), srs.get(),
                                              file.format.is_table ? wkbNone : wkbPoint25D, options.List());
  if (layer == nullptr) file.fail(file.format.driver + " could not create a layer of points");
  const std::vector<Field> fields = file.add_fields(*layer, type, landmarks);
  const std::string style =
      fmt::format("SYMBOL(s:0.8,c:{})", type.colour);  // GDAL 3.6's LIBKML needs the size
  const bool one_transaction = layer->StartTransaction() == OGRERR_NONE;
  landmarks([&](const Landmark& landmark) {
    OGRFeature feature(layer->GetLayerDefn());
    for (const Field& field : fields)
      set_field(feature, field.index, field.column.value(landmark), file.format.is_table);
    if (!file.format.is_table) {
      const auto& p = landmark.position.xyz;
      feature.SetGeometryDirectly(new OGRPoint(p.x(), p.y(), p.z()));
      feature.SetStyleString(style.c_str());
    }
    if (layer->CreateFeature(&feature) != OGRERR_NONE) file.fail("a landmark was refused");
  });
  if (one_transaction && layer->CommitTransaction() != OGRERR_NONE)
    file.fail("the layer could not be committed");
}

std::vector<std::string> OgrOutput::close() {
  File& file = *file_;
  file.dataset->FlushCache();
  const bool full = disk_is_full(file.output_name);  // closing may remove the temporary file that filled it
  file.dataset.reset();
  if (!file.messages.failures().empty() && full) fail_full_disk(file.output_name);
  if (!file.messages.failures().empty()) file.fail("closing it failed");
  if (failed_writes() != file.failed_before) file.fail("a write failed");
  std::vector<std::string> warnings = file.warnings;
  for (const std::string& said : file.messages.warnings())
    warnings.push_back(file.format.driver + ": " + said);
  return warnings;
}

}  // namespace waymark::exporters
