// SPDX-License-Identifier: Apache-2.0
#include "exporters/raster/cog_file.hpp"

#include <gdal_priv.h>

#include <array>
#include <limits>

#include "core/atomic_file.hpp"
#include "exporters/gdal_messages.hpp"
#include "exporters/raster/copy_as_cog.hpp"

namespace waymark::exporters {
namespace {

// Bands in memory that GDAL reads without a copy.
GDALDatasetUniquePtr memory_raster(const std::vector<RasterBand>& bands, const Georeference& where) {
  const Grid<float>& first = *bands.front().cells;
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDatasetUniquePtr raster(memory->Create("", static_cast<int>(first.columns()),
                                             static_cast<int>(first.rows()), 0, GDT_Float32, nullptr));
  // GDAL's origin is the corner of the first cell.
  std::array<double, 6> transform{where.x0 - where.dx / 2, where.dx, 0, where.y0 - where.dy / 2, 0, where.dy};
  raster->SetGeoTransform(transform.data());
  if (where.crs.kind() != CrsKind::local) {
    OGRSpatialReference reference;
    reference.SetFromUserInput(where.crs.wkt2().c_str());
    raster->SetSpatialRef(&reference);
  }
  for (std::size_t b = 0; b < bands.size(); ++b) {
    std::array<char, 64> text{};
    auto* data = const_cast<float*>(bands[b].cells->cells().data());  // MEM only reads it here
    text[static_cast<std::size_t>(CPLPrintPointer(text.data(), data, static_cast<int>(text.size()) - 1))] = 0;
    const std::string option = "DATAPOINTER=" + std::string(text.data());
    const std::array<const char*, 2> options{option.c_str(), nullptr};
    raster->AddBand(GDT_Float32, const_cast<char**>(options.data()));
    GDALRasterBand* band = raster->GetRasterBand(static_cast<int>(b) + 1);
    band->SetDescription(bands[b].name.c_str());
    band->SetUnitType(bands[b].unit.c_str());
    band->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  }
  return raster;
}

}  // namespace

void write_cog(const std::filesystem::path& path, const std::vector<RasterBand>& bands,
               const Georeference& where, const std::map<std::string, std::string>& metadata) {
  AtomicFile aside(path);
  GdalMessages messages;
  const GDALDatasetUniquePtr raster = memory_raster(bands, where);
  for (const auto& [key, value] : metadata) raster->SetMetadataItem(key.c_str(), value.c_str());
  copy_as_cog(*raster, aside, path, messages);
}

}  // namespace waymark::exporters
