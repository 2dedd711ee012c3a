// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/block.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "geo/dem_source.hpp"

namespace waymark::importers {
namespace {

[[noreturn]] void refuse(const RasterHeader& header, int column, int row, const std::string& said) {
  throw Error(ErrorCode::input,
              fmt::format("block ({}, {}) of the file cannot be read: {}", column, row,
                          said.empty() ? "it is damaged" : said),
              header.path, "the file is truncated or damaged: fetch or write it again");
}

template <class T>
constexpr GDALDataType gdal_type() {
  if constexpr (std::is_same_v<T, std::int16_t>) return GDT_Int16;
  if constexpr (std::is_same_v<T, float>) return GDT_Float32;
  return GDT_Float64;
}

template <class T>
std::vector<T> read_cells(GDALRasterBand& band, const RasterHeader& header, int column, int row) {
  const auto count =
      static_cast<std::size_t>(header.block_columns) * static_cast<std::size_t>(header.block_rows);
  const GDALDataType stored = band.GetRasterDataType();
  const GdalListener gdal;
  std::vector<T> cells(count);
  CPLErr result = CE_None;
  if (stored == gdal_type<T>()) {
    result = band.ReadBlock(column, row, cells.data());
  } else {
    const int size = GDALGetDataTypeSizeBytes(stored);
    std::vector<std::byte> raw(count * static_cast<std::size_t>(size));
    result = band.ReadBlock(column, row, raw.data());
    GDALCopyWords64(raw.data(), stored, size, cells.data(), gdal_type<T>(), sizeof(T),
                    static_cast<GPtrDiff_t>(count));
  }
  if (result != CE_None || gdal.content_is_missing())
    refuse(header, column, row, gdal.error_about(header.path));
  return cells;
}

// Sets masked cells to NaN, which is never a height.
template <class T>
void apply_mask(GDALRasterBand& band, const RasterHeader& header, int column, int row,
                std::vector<T>& cells) {
  const int left = column * header.block_columns, top = row * header.block_rows;
  const int columns = static_cast<int>(std::min<std::int64_t>(header.block_columns, header.columns - left));
  const int rows = static_cast<int>(std::min<std::int64_t>(header.block_rows, header.rows - top));
  std::vector<std::uint8_t> shown(cells.size());
  const GdalListener gdal;
  if (band.GetMaskBand()->RasterIO(GF_Read, left, top, columns, rows, shown.data(), columns, rows, GDT_Byte,
                                   1, header.block_columns, nullptr) != CE_None ||
      gdal.content_is_missing())
    refuse(header, column, row, gdal.error_about(header.path));
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (shown[i] == 0) cells[i] = std::numeric_limits<T>::quiet_NaN();
}

// False for NaN and infinities.
bool is_plausible(double height, const HeightScale& heights) {
  return height >= heights.min_height && height <= heights.max_height && std::isfinite(height);
}

// Branch-free, so that the compiler may vectorise.
template <class T>
void copy(std::span<const T> from, const HeightScale& heights, std::span<double> into) {
  for (std::size_t i = 0; i < into.size(); ++i) {
    const double value = from[i];
    const double height = value * heights.scale + heights.offset;
    const bool known =
        !(value >= heights.min_void && value <= heights.max_void) && is_plausible(height, heights);
    into[i] = into[i] != kNoHeight ? into[i] : known ? height : kNoHeight;
  }
}

template <class T>
ImplausibleCells count_implausible(std::span<const T> cells, const HeightScale& heights) {
  const auto implausible = [&](double value) {
    return !(value >= heights.min_void && value <= heights.max_void) && std::isfinite(value) &&
           !is_plausible(value * heights.scale + heights.offset, heights);
  };
  ImplausibleCells found;
  for (const T value : cells) found.count += implausible(value) ? 1 : 0;
  if (found.count == 0) return found;
  const auto first = std::ranges::find_if(cells, implausible);
  found.first = static_cast<std::size_t>(first - cells.begin());
  found.height = static_cast<double>(*first) * heights.scale + heights.offset;
  return found;
}

}  // namespace

std::size_t Block::bytes() const {
  return std::visit([](const auto& values) { return values.size() * sizeof(values[0]); }, cells);
}

Block read_block(GDALDataset& dataset, const RasterHeader& header, int block_column, int block_row) {
  GDALRasterBand& band = *dataset.GetRasterBand(header.band);
  if (header.cells == CellType::int16)
    return {read_cells<std::int16_t>(band, header, block_column, block_row)};
  const auto masked = [&](auto cells) {
    if (header.masked) apply_mask(band, header, block_column, block_row, cells);
    return Block{std::move(cells)};
  };
  if (header.cells == CellType::float32)
    return masked(read_cells<float>(band, header, block_column, block_row));
  return masked(read_cells<double>(band, header, block_column, block_row));
}

ImplausibleCells implausible_cells(const Block& block, std::size_t first, std::size_t count,
                                   const HeightScale& scale) {
  ImplausibleCells found = std::visit(
      [&](const auto& cells) { return count_implausible(std::span(cells).subspan(first, count), scale); },
      block.cells);
  found.first += first;
  return found;
}

void copy_heights(const Block& block, std::size_t first, const HeightScale& scale, std::span<double> into) {
  std::visit([&](const auto& cells) { copy(std::span(cells).subspan(first, into.size()), scale, into); },
             block.cells);
}

}  // namespace waymark::importers
