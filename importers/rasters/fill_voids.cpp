// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/fill_voids.hpp"

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>

#include <algorithm>
#include <memory>

#include "core/error.hpp"
#include "importers/gdal_session.hpp"

namespace waymark::importers {
namespace {

Window clip_to_grid(const Window& window, const GridGeometry& grid) {
  if (!grid.wraps) return intersection(window, {0, 0, grid.columns, grid.rows});
  return intersection(window, {window.column, 0, window.columns, grid.rows});
}

// Returns the smallest window with all voids of `part`.
Window bounds_of_voids(const HeightWindow& heights, const Window& part, const Window& window) {
  std::int64_t left = part.end_column(), right = part.column, top = part.end_row(), bottom = part.row;
  for (std::int64_t row = part.row; row < part.end_row(); ++row)
    for (std::int64_t column = part.column; column < part.end_column(); ++column) {
      if (heights(column - window.column, row - window.row) != kNoHeight) continue;
      left = std::min(left, column), right = std::max(right, column + 1);
      top = std::min(top, row), bottom = std::max(bottom, row + 1);
    }
  return {left, top, std::max<std::int64_t>(0, right - left), std::max<std::int64_t>(0, bottom - top)};
}

// Wraps cells in a GDAL data set without copying.
template <class T>
GdalDataset memory_raster(std::vector<T>& cells, const Window& window, const char* type) {
  const std::string name =
      fmt::format("MEM:::DATAPOINTER={},PIXELS={},LINES={},DATATYPE={}",
                  static_cast<const void*>(cells.data()), window.columns, window.rows, type);
  return GdalDataset(GDALDataset::Open(name.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
}

// GDAL computes in Float32, whatever the raster holds. It leaves a void that it cannot fill unchanged.
std::vector<float> interpolated(const HeightWindow& heights, const Window& window, int distance) {
  std::vector<float> cells;
  std::vector<std::uint8_t> known;
  for (const double height : heights.cells()) {
    known.push_back(height == kNoHeight ? 0 : 255);
    cells.push_back(static_cast<float>(height));
  }
  const GdalListener gdal;
  const GdalDataset raster = memory_raster(cells, window, "Float32"),
                    mask = memory_raster(known, window, "Byte");
  char temporary[] = "TEMP_FILE_DRIVER=MEM";
  char* options[] = {temporary, nullptr};
  if (!raster || !mask ||
      GDALFillNodata(raster->GetRasterBand(1), mask->GetRasterBand(1), distance, 0, 0, options, nullptr,
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

HeightWindow read_filled(const Mosaic& mosaic, const Window& window, int distance) {
  HeightWindow heights = mosaic.read(window);
  const Window holes = bounds_of_voids(heights, clip_to_grid(window, mosaic.grid()), window);
  if (holes.cells() == 0) return heights;
  const Window around = clip_to_grid({holes.column - distance, holes.row - distance,
                                      holes.columns + 2 * distance, holes.rows + 2 * distance},
                                     mosaic.grid());
  const HeightWindow sources = mosaic.read(around);
  if (std::ranges::all_of(sources.cells(), [](double height) { return height == kNoHeight; })) return heights;
  const std::vector<float> cells = interpolated(sources, around, distance);
  const bool whole =
      std::ranges::all_of(mosaic.headers(), [](const auto& h) { return h.heights.whole_metres; });
  for (std::int64_t row = holes.row; row < holes.end_row(); ++row)
    for (std::int64_t column = holes.column; column < holes.end_column(); ++column) {
      double& height = heights(column - window.column, row - window.row);
      const float filled =
          cells[static_cast<std::size_t>((row - around.row) * around.columns + column - around.column)];
      if (height == kNoHeight && filled != static_cast<float>(kNoHeight))
        height = whole ? rounded(filled) : filled;
    }
  return heights;
}

}  // namespace waymark::importers
