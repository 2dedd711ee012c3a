// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/vector_layer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <memory>

#include "core/error.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kMaxHead = 65536;  // bytes of a GML file in which its CRS is named

/// Throws Error{input} if an SQLite file has a recursive view: GDAL would read its rows without end.
void refuse_recursive_views(GDALDataset& dataset, const std::string& path) {
  const std::string driver = dataset.GetDriverName();
  if (driver != "GPKG" && driver != "SQLite") return;
  const GdalListener quiet;
  const std::string query(geodb::sql_text("recursive_views"));
  OGRLayer* views = dataset.ExecuteSQL(query.c_str(), nullptr, "");
  if (views == nullptr) return;
  std::string name;
  if (const OGRFeatureUniquePtr row{views->GetNextFeature()}) name = row->GetFieldAsString(0);
  dataset.ReleaseResultSet(views);
  if (!name.empty())
    throw Error(ErrorCode::input,
                fmt::format("the file has a recursive view, '{}', whose rows need not end", name), path,
                "remove the view, or copy its rows into a table");
}

/// Returns whether positions of a GML file are latitude and longitude that GDAL does not exchange. GDAL
/// exchanges those of EPSG codes; the axes of any authority's urn have its order (OGC 07-036r1, 09-048r5).
bool keeps_latitude_first(GDALDataset& dataset, const std::string& path) {
  if (!EQUAL(dataset.GetDriverName(), "GML") || dataset.GetLayerCount() == 0) return false;
  const OGRSpatialReference* reference = dataset.GetLayer(0)->GetSpatialRef();
  const char* const authority = reference != nullptr ? reference->GetAuthorityName(nullptr) : nullptr;
  OGRAxisOrientation first = OAO_Other;
  if (authority == nullptr || EQUAL(authority, "EPSG") || !reference->IsGeographic()) return false;
  reference->GetAxis(nullptr, 0, &first);
  if (first != OAO_North) return false;
  std::string head(kMaxHead, '\0');
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(VSIFOpenL(path.c_str(), "rb"), VSIFCloseL);
  head.resize(file ? VSIFReadL(head.data(), 1, head.size(), file.get()) : 0);
  return head.find(fmt::format("urn:ogc:def:crs:{}:", authority)) != std::string::npos ||
         head.find(fmt::format("www.opengis.net/def/crs/{}/", authority)) != std::string::npos;
}

}  // namespace

GdalDataset open_vector(const std::string& path, const std::string& thing, const std::string& hint) {
  const GdalListener gdal;
  GdalDataset dataset(
      GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (dataset) {
    refuse_recursive_views(*dataset, path);
    if (keeps_latitude_first(*dataset, path)) {
      const char* const options[] = {"SWAP_COORDINATES=YES", nullptr};
      dataset.reset(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, options));
      if (!dataset) throw Error(ErrorCode::input, "this GML file cannot be read again", path, hint);
    }
    return dataset;
  }
  VSIStatBufL status;
  if (path.find(':') == std::string::npos && VSIStatL(path.c_str(), &status) != 0)
    throw Error(ErrorCode::input, "there is no such " + thing, path, "check the path");
  const std::string said = gdal.error_about(path);
  throw Error(ErrorCode::input, "this is no vector layer that GDAL reads" + (said.empty() ? "" : ": " + said),
              path, hint);
}

OGRLayer& layer_named(GDALDataset& dataset, const std::string& path, const std::string& name,
                      const std::vector<std::string>& all) {
  if (OGRLayer* layer = dataset.GetLayerByName(name.c_str())) return *layer;
  const std::string nearest = nearest_name(name, all);
  throw Error(
      ErrorCode::usage, fmt::format("the file has no layer '{}'", name), path,
      nearest.empty() ? fmt::format("it has {}", fmt::join(all, ", ")) : "did you mean '" + nearest + "'?");
}

std::optional<Crs> crs_of(OGRLayer& layer) {
  const OGRSpatialReference* reference = layer.GetSpatialRef();
  if (reference == nullptr) return {};
  char* wkt = nullptr;
  const char* const wkt2[] = {"FORMAT=WKT2_2019", nullptr};
  reference->exportToWkt(&wkt, wkt2);
  const std::string definition = wkt ? wkt : "";
  CPLFree(wkt);
  try {
    return definition.empty() ? std::optional<Crs>{} : Crs::from_text(definition);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace waymark::importers
