// SPDX-License-Identifier: Apache-2.0
#include "exporters/raster/occupancy_map.hpp"

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/output_error.hpp"
#include "exporters/gdal_messages.hpp"
#include "geodb/replace_map.hpp"

namespace waymark::exporters {
namespace {

namespace fs = std::filesystem;

GDALDatasetUniquePtr open_band(const fs::path& raster, int band, const fs::path& output,
                               const GdalMessages& messages) {
  GDALDatasetUniquePtr set(
      GDALDataset::Open(raster.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  if (!set || set->GetRasterCount() < band)
    fail_output(output, messages.cause("the raster that it is made from cannot be read"));
  return set;
}

}  // namespace

void write_occupancy_map(const fs::path& yaml, const fs::path& raster, int band) {
  const GdalMessages messages;
  const GDALDatasetUniquePtr set = open_band(raster, band, yaml, messages);
  std::array<double, 6> t{};
  set->GetGeoTransform(t.data());
  if (!(std::abs(t[1] + t[5]) < 1e-6 * t[1]))
    throw Error(ErrorCode::input,
                fmt::format("cells of {:g} x {:g} are not square, as those of Nav2 are", t[1], -t[5]),
                raster.string(), "resample the DEM: gdalwarp -tr");
  const int columns = set->GetRasterXSize(), rows = set->GetRasterYSize();
  const fs::path image = fs::path(yaml).replace_extension(".pgm");
  std::string pgm = fmt::format("P5\n{} {}\n255\n", columns, rows);
  pgm.reserve(pgm.size() + static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::vector<float> row(static_cast<std::size_t>(columns));
  for (int r = 0; r < rows; ++r) {
    if (set->GetRasterBand(band)->RasterIO(GF_Read, 0, r, columns, 1, row.data(), columns, 1, GDT_Float32, 0,
                                           0, nullptr) != CE_None)
      fail_output(yaml, messages.cause("the raster that it is made from cannot be read"));
    for (const float p : row)
      pgm.push_back(static_cast<char>(
          std::isnan(p) ? 255 : static_cast<unsigned char>(std::lround(100 * std::clamp(p, 0.F, 1.F)))));
  }
  write_file(image, pgm);
  write_file(yaml,
             fmt::format("image: {}\nmode: raw\nresolution: {:.9g}\norigin: [{:.9g}, {:.9g}, 0]\nnegate: 0\n"
                         "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
                         image.filename().string(), t[1], t[0], t[3] + rows * t[5]));
}

void write_class_polygons(const fs::path& geopackage, const std::string& layer_name, const fs::path& raster,
                          int band, std::span<const char* const> names) {
  const GdalMessages messages;
  const GDALDatasetUniquePtr set = open_band(raster, band, geopackage, messages);
  AtomicFile aside(geopackage);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  std::unique_ptr<GDALDataset> file(driver->Create(aside.path().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!file) fail_output(geopackage, messages.cause("GDAL has no GeoPackage driver"));
  const OGRSpatialReference* srs = set->GetSpatialRef();
  OGRLayer* layer =
      file->CreateLayer(layer_name.c_str(), const_cast<OGRSpatialReference*>(srs), wkbPolygon, nullptr);
  if (!layer) fail_output(geopackage, messages.cause("no layer"));
  for (auto [name, type] :
       {std::pair("code", OFTInteger), std::pair("class", OFTString), std::pair("area", OFTReal)}) {
    OGRFieldDefn field(name, type);
    if (layer->CreateField(&field) != OGRERR_NONE) fail_output(geopackage, messages.cause("no column"));
  }
  GDALRasterBand* cells = set->GetRasterBand(band);
  file->StartTransaction();
  // The band is its own mask: class 0 makes no polygons.
  bool made =
      GDALPolygonize(cells, cells, OGRLayer::ToHandle(layer), 0, nullptr, nullptr, nullptr) == CE_None;
  made = made && file->CommitTransaction() == OGRERR_NONE;
  std::string cases;
  for (std::size_t i = 1; i < names.size(); ++i) cases += fmt::format(" WHEN {} THEN '{}'", i, names[i]);
  const std::string fill =
      fmt::format("UPDATE \"{}\" SET class = CASE code{} END, area = ST_Area(geom)", layer_name, cases);
  if (made) file->ReleaseResultSet(file->ExecuteSQL(fill.c_str(), nullptr, "SQLITE"));
  file.reset();
  if (!made || !messages.failures().empty())
    fail_output(geopackage, messages.cause("not all of it was written"));
  geodb::replace_map(aside);
}

}  // namespace waymark::exporters
