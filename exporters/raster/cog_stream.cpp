// SPDX-License-Identifier: Apache-2.0
#include "exporters/raster/cog_stream.hpp"

#include <gdal_priv.h>

#include <array>
#include <limits>
#include <system_error>

#include "core/atomic_file.hpp"
#include "core/output_error.hpp"
#include "exporters/gdal_messages.hpp"
#include "exporters/raster/copy_as_cog.hpp"

namespace waymark::exporters {

struct CogStream::File {
  std::filesystem::path path;
  GdalMessages messages;
  AtomicFile aside;
  std::filesystem::path collected;  ///< removed with the folder that `aside` lies in
  GDALDatasetUniquePtr raster;

  explicit File(const std::filesystem::path& output)
      : path(output), aside(output), collected(aside.path().parent_path() / "collected.tif") {}
};

CogStream::CogStream(const std::filesystem::path& path, const std::vector<Band>& bands,
                     const GridGeometry& grid)
    : file_(std::make_unique<File>(path)) {
  const std::array<const char*, 5> options{"TILED=YES", "BLOCKXSIZE=512", "BLOCKYSIZE=512",
                                           "BIGTIFF=IF_SAFER", nullptr};
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  file_->raster.reset(driver->Create(file_->collected.c_str(), static_cast<int>(grid.columns),
                                     static_cast<int>(grid.rows), static_cast<int>(bands.size()), GDT_Float32,
                                     const_cast<char**>(options.data())));
  if (!file_->raster) fail_output(path, file_->messages.cause("GDAL cannot create it"));
  const Georeference& where = grid.where;
  // GDAL's origin is the corner of the first cell.
  std::array<double, 6> transform{where.x0 - where.dx / 2, where.dx, 0, where.y0 - where.dy / 2, 0, where.dy};
  file_->raster->SetGeoTransform(transform.data());
  if (where.crs.kind() != CrsKind::local) {
    OGRSpatialReference reference;
    reference.SetFromUserInput(where.crs.wkt2().c_str());
    file_->raster->SetSpatialRef(&reference);
  }
  for (std::size_t b = 0; b < bands.size(); ++b) {
    GDALRasterBand* band = file_->raster->GetRasterBand(static_cast<int>(b) + 1);
    band->SetDescription(bands[b].name.c_str());
    band->SetUnitType(bands[b].unit.c_str());
    band->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  }
}

// After a failed write, libtiff may follow the directories of the file without an end. An empty file has
// none.
CogStream::~CogStream() {
  std::error_code ignored;
  if (file_ && file_->raster) std::filesystem::resize_file(file_->collected, 0, ignored);
}

void CogStream::write(const Window& window, std::span<const Grid<float>> bands) {
  const int columns = static_cast<int>(window.columns), rows = static_cast<int>(window.rows);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    auto* cells = const_cast<float*>(bands[b].cells().data());  // RasterIO only reads it
    if (file_->raster->GetRasterBand(static_cast<int>(b) + 1)
            ->RasterIO(GF_Write, static_cast<int>(window.column), static_cast<int>(window.row), columns, rows,
                       cells, columns, rows, GDT_Float32, 0, 0, nullptr) != CE_None)
      fail_output(file_->path, file_->messages.cause("not all of it was written"));
  }
}

void CogStream::commit(const std::map<std::string, std::string>& metadata) {
  for (const auto& [key, value] : metadata) file_->raster->SetMetadataItem(key.c_str(), value.c_str());
  file_->raster->FlushCache(false);
  if (!file_->messages.failures().empty())
    fail_output(file_->path, file_->messages.cause("not all of it was written"));
  copy_as_cog(*file_->raster, file_->aside, file_->path, file_->messages);
  file_->raster.reset();
}

}  // namespace waymark::exporters
