// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/inspect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

constexpr double kSeamTolerance = 1e-3;  // metres
constexpr std::size_t kMaxSeamsListed = 20;
constexpr std::int64_t kPiece = 1024;      // cells on a side, read at once
constexpr std::int64_t kQuickPiece = 256;  // the same if the first piece is usually enough

// Calls visit(piece) for squares of `side` cells of the window, row by row, until it returns false.
void for_each_piece(const Window& window, std::int64_t side, auto&& visit) {
  for (std::int64_t row = window.row; row < window.end_row(); row += side)
    for (std::int64_t column = window.column; column < window.end_column(); column += side)
      if (!visit(intersection({column, row, side, side}, window))) return;
}

// An interrupted download lacks the end of the file.
void check_ends(const Mosaic& mosaic) {
  for (std::size_t file = 0; file < mosaic.headers().size(); ++file) {
    const Window& whole = mosaic.window_of(file);
    const bool turned = mosaic.headers()[file].south_up;
    mosaic.read_file(file, {whole.end_column() - 1, turned ? whole.row : whole.end_row() - 1, 1, 1});
  }
}

void check_relief(const Mosaic& mosaic, std::vector<std::string>& warnings) {
  double low = std::numeric_limits<double>::infinity(), high = kNoHeight;
  for_each_piece({0, 0, mosaic.grid().columns, mosaic.grid().rows}, kQuickPiece, [&](const Window& piece) {
    const HeightWindow heights = mosaic.read(piece);
    for (const double height : heights.cells()) {
      if (height == kNoHeight) continue;
      low = std::min(low, height);
      high = std::max(high, height);
    }
    return !(low < high);
  });
  if (high == kNoHeight)
    throw Error(ErrorCode::input, "the DEM has no heights: every cell is no-data", mosaic.headers()[0].path,
                "check the no-data value: gdalinfo -mm, and gdal_edit.py -unsetnodata where it is wrong");
  if (low == high)
    warnings.push_back(
        fmt::format("every cell has the height {} m: there is no relief to find landmarks in", low));
}

struct Disagreement {
  std::int64_t shared = 0, different = 0;
  double largest = 0;
  std::int64_t column = 0, row = 0;  ///< of the largest difference, in the grid
};

Disagreement compare(const Mosaic& mosaic, std::size_t first, std::size_t second, const Window& overlap) {
  Disagreement found;
  for_each_piece(overlap, kPiece, [&](const Window& piece) {
    const HeightWindow a = mosaic.read_file(first, piece), b = mosaic.read_file(second, piece);
    for (std::int64_t row = 0; row < piece.rows; ++row)
      for (std::int64_t column = 0; column < piece.columns; ++column) {
        if (a(column, row) == kNoHeight || b(column, row) == kNoHeight) continue;
        ++found.shared;
        const double difference = std::abs(a(column, row) - b(column, row));
        if (!(difference > kSeamTolerance)) continue;
        ++found.different;
        if (difference > found.largest)
          found = {found.shared, found.different, difference, piece.column + column, piece.row + row};
      }
    return true;
  });
  return found;
}

void check_seams(const Mosaic& mosaic, std::vector<std::string>& warnings) {
  const auto& files = mosaic.headers();
  std::size_t seams = 0;
  for (std::size_t i = 0; i < files.size(); ++i)
    for (std::size_t j = i + 1; j < files.size(); ++j) {
      const Window overlap = intersection(mosaic.window_of(i), mosaic.window_of(j));
      if (overlap.cells() == 0) continue;
      const Disagreement found = compare(mosaic, i, j, overlap);
      if (found.different == 0 || ++seams > kMaxSeamsListed) continue;
      const Georeference& where = mosaic.grid().where;
      warnings.push_back(
          fmt::format("{} and {} disagree in {} of {} shared cells, by up to {:.6g} m at ({:.6f}, {:.6f}); "
                      "the first one has priority",
                      files[i].path, files[j].path, found.different, found.shared, found.largest,
                      where.x(static_cast<double>(found.column)), where.y(static_cast<double>(found.row))));
    }
  if (seams > kMaxSeamsListed)
    warnings.push_back(fmt::format("{} more seams disagree", seams - kMaxSeamsListed));
}

void check_layout(const Mosaic& mosaic, std::size_t cache_bytes, std::vector<std::string>& warnings) {
  for (const RasterHeader& header : mosaic.headers()) {
    const double cell = header.cells == CellType::int16 ? 2 : header.cells == CellType::float32 ? 4 : 8;
    const double band =
        cell * static_cast<double>(header.columns) * std::max<double>(kPiece, header.block_rows);
    if (header.block_columns < 2 * kPiece || band <= static_cast<double>(cache_bytes)) continue;
    warnings.push_back(
        fmt::format("{} is stored in strips of {} columns, which are decoded repeatedly: raise the "
                    "memory to {:.0f} MB, "
                    "or convert it: gdal_translate -of COG -co COMPRESS=ZSTD '{}' tiled.tif",
                    header.path, header.block_columns, std::ceil(1.2e-6 * band), header.path));
  }
}

}  // namespace

std::vector<std::string> inspect(const Mosaic& mosaic, std::size_t cache_bytes) {
  std::vector<std::string> warnings;
  check_layout(mosaic, cache_bytes, warnings);
  check_ends(mosaic);
  check_relief(mosaic, warnings);
  check_seams(mosaic, warnings);
  return warnings;
}

}  // namespace waymark::importers
