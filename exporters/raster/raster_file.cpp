// SPDX-License-Identifier: Apache-2.0
#include "exporters/raster/raster_file.hpp"

#include <gdal_priv.h>

#include <limits>

#include "core/atomic_file.hpp"
#include "core/output_error.hpp"
#include "exporters/gdal_messages.hpp"

namespace waymark::exporters {

void write_raster(const std::filesystem::path& path, const Grid<float>& cells, const Georeference& where) {
  GdalMessages messages;
  AtomicFile aside(path);
  const int columns = static_cast<int>(cells.columns()), rows = static_cast<int>(cells.rows());
  const char* const options[] = {"COMPRESS=DEFLATE", "PREDICTOR=3", "TILED=YES", "BIGTIFF=IF_SAFER", nullptr};
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  GDALDatasetUniquePtr file(
      driver->Create(aside.path().c_str(), columns, rows, 1, GDT_Float32, const_cast<char**>(options)));
  if (!file) fail_output(path, messages.cause("GDAL cannot create it"));
  // GDAL's origin is the corner of the first cell.
  double transform[] = {where.x0 - where.dx / 2, where.dx, 0, where.y0 - where.dy / 2, 0, where.dy};
  file->SetGeoTransform(transform);
  if (where.crs.kind() != CrsKind::local) {
    OGRSpatialReference reference;
    reference.SetFromUserInput(where.crs.wkt2().c_str());
    file->SetSpatialRef(&reference);
  }
  GDALRasterBand* band = file->GetRasterBand(1);
  band->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  auto* first = const_cast<float*>(cells.cells().data());  // RasterIO only reads it
  const bool written = band->RasterIO(GF_Write, 0, 0, columns, rows, first, columns, rows, GDT_Float32, 0, 0,
                                      nullptr) == CE_None;
  file.reset();
  if (!written || !messages.failures().empty())
    fail_output(path, messages.cause("not all of it was written"));
  aside.commit();
}

}  // namespace waymark::exporters
