// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/fill_voids.hpp"

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>

#include <algorithm>
#include <memory>

#include "core/error.hpp"
#include "importers/gdal_session.hpp"

namespace waymark {
namespace {

constexpr int kReach = 100;  // cells; the default of gdal_fillnodata

Window in_grid(const Window& window, const GridGeometry& grid) {
  if (!grid.wraps) return common(window, {0, 0, grid.columns, grid.rows});
  return common(window, {window.column, 0, window.columns, grid.rows});
}

bool has_voids(const HeightWindow& heights, const Window& part, const Window& window) {
  for (std::int64_t row = part.row; row < part.end_row(); ++row)
    for (std::int64_t column = part.column; column < part.end_column(); ++column)
      if (heights(column - window.column, row - window.row) == kNoHeight) return true;
  return false;
}

// A GDAL band on memory of ours.
template <class T>
GdalDataset in_memory(std::vector<T>& cells, const Window& window, const char* type) {
  const std::string name =
      fmt::format("MEM:::DATAPOINTER={},PIXELS={},LINES={},DATATYPE={}",
                  static_cast<const void*>(cells.data()), window.columns, window.rows, type);
  return GdalDataset(GDALDataset::Open(name.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
}

// Float32 is what GDAL computes with, whatever the raster holds. It leaves a void it cannot fill as it was.
std::vector<float> interpolated(const HeightWindow& heights, const Window& window) {
  std::vector<float> cells;
  std::vector<std::uint8_t> known;
  for (const double height : heights.cells()) {
    known.push_back(height == kNoHeight ? 0 : 255);
    cells.push_back(static_cast<float>(height));
  }
  const GdalListener gdal;
  const GdalDataset raster = in_memory(cells, window, "Float32"), mask = in_memory(known, window, "Byte");
  char temporary[] = "TEMP_FILE_DRIVER=MEM";
  char* options[] = {temporary, nullptr};
  if (!raster || !mask ||
      GDALFillNodata(raster->GetRasterBand(1), mask->GetRasterBand(1), kReach, 0, 0, options, nullptr,
                     nullptr))
    throw Error(ErrorCode::environment, "filling voids failed: " + gdal.error_about(""), "",
                "use --nodata ocean or unknown, or fewer threads if memory is short");
  raster->FlushCache(false);
  return cells;
}

double rounded(float height) {
  return static_cast<int>(height > 0 ? height + 0.5F : height - 0.5F);
}

}  // namespace

HeightWindow read_filled(const Mosaic& mosaic, const Window& window) {
  HeightWindow heights = mosaic.read(window);
  const Window inside = in_grid(window, mosaic.grid());
  if (!has_voids(heights, inside, window)) return heights;
  const Window around = in_grid(
      {inside.column - kReach, inside.row - kReach, inside.columns + 2 * kReach, inside.rows + 2 * kReach},
      mosaic.grid());
  const std::vector<float> cells = interpolated(mosaic.read(around), around);
  const bool whole =
      std::ranges::all_of(mosaic.headers(), [](const auto& h) { return h.heights.whole_metres; });
  for (std::int64_t row = inside.row; row < inside.end_row(); ++row)
    for (std::int64_t column = inside.column; column < inside.end_column(); ++column) {
      double& height = heights(column - window.column, row - window.row);
      const float filled =
          cells[static_cast<std::size_t>((row - around.row) * around.columns + column - around.column)];
      if (height == kNoHeight && filled != static_cast<float>(kNoHeight))
        height = whole ? rounded(filled) : filled;
    }
  return heights;
}

}  // namespace waymark
