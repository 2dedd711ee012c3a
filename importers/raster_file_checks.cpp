// SPDX-License-Identifier: Apache-2.0
#include "importers/raster_file_checks.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "importers/gdal_session.hpp"

namespace waymark::importers {
namespace {

// Deflate stores at most 1,032 bytes in one; a block may be larger than the file by this ratio.
constexpr double kBigBlock = 64e6, kMaxRatio = 2000;

/// Throws Error{input} for a block that is large and can by no means be stored in the file: reading a cell
/// would allocate it all.
void check_blocks(GDALDataset& dataset, const std::string& path) {
  VSIStatBufL status;
  if (dataset.GetRasterCount() == 0 || VSIStatL(path.c_str(), &status) != 0) return;
  int columns = 0, rows = 0;
  GDALRasterBand* const band = dataset.GetRasterBand(1);
  band->GetBlockSize(&columns, &rows);
  const double bytes =
      static_cast<double>(columns) * rows * GDALGetDataTypeSizeBytes(band->GetRasterDataType());
  if (bytes <= kBigBlock || bytes <= kMaxRatio * static_cast<double>(status.st_size)) return;
  throw Error(ErrorCode::input,
              fmt::format("the header states blocks of {} x {} cells ({:.3g} MB), but the file has {:.3g} MB",
                          columns, rows, bytes / 1e6, static_cast<double>(status.st_size) / 1e6),
              path, "the file is damaged or hostile; a sound one can be tiled: gdal_translate -co TILED=YES");
}

/// Throws Error{input} if a row of a text grid is missing. GDAL looks for a row in all rows before it, and
/// again for each of these that is missing, so a read of the last row of a file that ends early would not
/// end.
void check_rows_of_text(GDALDataset& dataset, const std::string& path) {
  const std::string format = dataset.GetDriverName();
  if (format != "AAIGrid" && format != "GRASSASCIIGrid" && format != "ISG") return;
  GDALRasterBand* const band = dataset.GetRasterBand(1);
  std::vector<double> row(static_cast<std::size_t>(band->GetXSize()));
  for (int i = 0; i < band->GetYSize(); ++i) {
    const GdalListener gdal;
    if (band->ReadBlock(0, i, row.data()) != CE_None)
      throw Error(
          ErrorCode::input,
          fmt::format("row {} of {} cannot be read: {}", i + 1, band->GetYSize(), gdal.error_about(path)),
          path, "the file is truncated or damaged: fetch or write it again");
  }
}

/// Returns the file that holds the cells; empty if the raster is no single file.
std::string file_of_cells(GDALDataset& dataset) {
  const std::unique_ptr<char*, void (*)(char**)> files(dataset.GetFileList(), CSLDestroy);
  return files && *files ? std::string(*files) : "";
}

/// Returns whether every cell has its bytes in the file and GDAL reads those beyond its end as zeros.
bool stores_all_cells(GDALDataset& dataset, const std::string& file) {
  const std::string format = dataset.GetDriverName();
  if (format != "ENVI" && format != "netCDF") return false;
  std::array<char, 3> head = {};
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> opened(VSIFOpenL(file.c_str(), "rb"), VSIFCloseL);
  if (!opened || VSIFReadL(head.data(), 1, head.size(), opened.get()) != head.size()) return false;
  const std::string_view magic(head.data(), head.size());
  if (format == "netCDF") return magic == "CDF";  // the classic format; others are HDF5
  return !magic.starts_with("\x1f\x8b");          // ENVI files may be of gzip
}

void check_size(GDALDataset& dataset, const std::string& path) {
  const GdalListener quiet;
  if (dataset.GetRasterCount() == 0) return;
  const std::string file = file_of_cells(dataset);
  VSIStatBufL status;
  if (file.empty() || !stores_all_cells(dataset, file) || VSIStatL(file.c_str(), &status) != 0) return;
  double bytes = 0;
  for (int band = 1; band <= dataset.GetRasterCount(); ++band)
    bytes += static_cast<double>(dataset.GetRasterXSize()) * dataset.GetRasterYSize() *
             GDALGetDataTypeSizeBytes(dataset.GetRasterBand(band)->GetRasterDataType());
  if (static_cast<double>(status.st_size) >= bytes) return;
  throw Error(ErrorCode::input,
              fmt::format("the file has {} bytes, but its cells need {:.0f}", status.st_size, bytes), path,
              "the file is truncated: fetch or write it again");
}

}  // namespace

void check_raster_file(GDALDataset& dataset, const std::string& path) {
  check_blocks(dataset, path);
  check_size(dataset, path);
  check_rows_of_text(dataset, path);
}

}  // namespace waymark::importers
