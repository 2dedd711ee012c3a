// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/export_check.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "core/output_error.hpp"
#include "exporters/gdal_messages.hpp"
#include "exporters/vector/count_rows.hpp"

namespace waymark::exporters {
namespace {

void require_all(std::int64_t found, std::int64_t landmarks, const std::string& output_name,
                 const GdalMessages& messages) {
  if (found < landmarks)
    fail_output(output_name,
                messages.cause(fmt::format("only {} of {} landmarks arrived", found, landmarks)));
}

/// Returns whether SpatiaLite's index of a layer and the three triggers that maintain it exist.
bool has_spatial_index(GDALDataset& dataset, const std::string& layer) {
  const std::string sql = fmt::format(
      "SELECT count(*) FROM sqlite_master WHERE lower(name) IN ('idx_{0}_geometry', "
      "'gii_{0}_geometry', 'giu_{0}_geometry', 'gid_{0}_geometry')",
      layer);
  OGRLayer* found = dataset.ExecuteSQL(sql.c_str(), nullptr, nullptr);
  if (found == nullptr) return false;
  const OGRFeatureUniquePtr row(found->GetNextFeature());
  const bool all = row && row->GetFieldAsInteger(0) == 4;
  dataset.ReleaseResultSet(found);
  return all;
}

/// Returns how far a reader would place the landmarks of a layer off their positions, at most, in metres.
double displacement(OGRLayer& layer, const OGRSpatialReference& kept, const Crs& crs) {
  OGREnvelope box;
  if (layer.GetExtent(&box) != OGRERR_NONE) return 0;
  OGRSpatialReference read(kept);
  read.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRSpatialReference> degrees(read.CloneGeogCS());
  if (!degrees) return 0;
  degrees->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> to_degrees(
      OGRCreateCoordinateTransformation(&read, degrees.get()));
  if (!to_degrees) return 0;
  const CrsTransform transform(crs, geographic_crs(crs));
  const Geodesic geodesic(crs.body());
  double max_distance = 0;
  for (const auto& [x, y] : {std::pair(box.MinX, box.MinY), {box.MaxX, box.MaxY}}) {
    double lon = x, lat = y;
    const CrsTransform::XY is = transform(x, y);
    if (!std::isfinite(is.x) || !to_degrees->Transform(1, &lon, &lat)) continue;
    max_distance = std::max(max_distance, geodesic.distance({is.x, is.y}, {lon, lat}));
  }
  return max_distance;
}

}  // namespace

std::vector<std::string> check_export(const VectorFormat& format, const std::string& path,
                                      const std::string& output_name, const Crs& crs,
                                      std::int64_t landmarks) {
  if (!format.can_be_read) return {};
  GdalMessages messages;
  if (has_rows_of_text(format.driver)) {
    const auto rows = count_rows(format.driver, path);
    if (!rows) fail_output(output_name, messages.cause("parts of it are missing"));
    require_all(*rows, landmarks, output_name, messages);
    return {};
  }
  const char* only[] = {format.driver.c_str(), nullptr};
  const std::unique_ptr<GDALDataset> dataset(
      GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, only, nullptr, nullptr));
  if (!dataset) fail_output(output_name, messages.cause("it cannot be read again"));
  std::int64_t found = 0;
  for (OGRLayer* layer : dataset->GetLayers()) found += layer->GetFeatureCount();
  require_all(found, landmarks, output_name, messages);
  // GDAL does not report an index that SpatiaLite could not make.
  if (format.driver == "SQLite" && !format.creation_options.empty())
    for (OGRLayer* layer : dataset->GetLayers())
      if (!has_spatial_index(*dataset, layer->GetName()))
        fail_output(output_name, "its spatial index is missing");
  if (format.is_table || crs.kind() == CrsKind::local || dataset->GetLayerCount() == 0) return {};

  const OGRSpatialReference* kept = dataset->GetLayer(0)->GetSpatialRef();
  const bool same_body =
      kept != nullptr && std::abs(kept->GetSemiMajor() / crs.body().equatorial_radius - 1) < 0.005;
  if (!same_body && crs.body().name != earth().name)
    throw Error(ErrorCode::output,
                fmt::format("{} cannot hold the CRS {}: a reader would place it {}", format.driver, crs.id(),
                            kept == nullptr ? "nowhere" : "on another body"),
                output_name,
                "write .gpkg, .fgb or .shp, which keep the CRS, or .csv, which has plain columns");
  if (kept == nullptr)
    return {fmt::format("{} does not store the CRS: readers need to know that it is {}", format.driver,
                        crs.id())};
  constexpr double kMaxDisplacement = 1;  // m: parameters are stored with few digits
  if (const double off = displacement(*dataset->GetLayer(0), *kept, crs); !(off < kMaxDisplacement))
    throw Error(ErrorCode::output,
                fmt::format("{} cannot hold the CRS {}: a reader would place landmarks {:.0f} m off",
                            format.driver, crs.id(), off),
                output_name, "write .gpkg, .fgb or .shp, or pass --crs, e.g. degrees");
  if (crs.authority().empty() || kept->GetAuthorityCode(nullptr) != nullptr) return {};
  return {fmt::format("{} stores the definition of the CRS, not its code {}", format.driver, crs.id())};
}

}  // namespace waymark::exporters
