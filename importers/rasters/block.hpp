// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>
#include "importers/rasters/raster_header.hpp"
namespace waymark::importers {

/// A decoded block of a file: `block_rows` rows of `block_columns` cells, in the file's order, unscaled.
/// Masked cells are NaN. Cells beyond the edge of the file have any value.
struct Block {
  std::variant<std::vector<std::int16_t>, std::vector<float>, std::vector<double>> cells;

  std::size_t bytes() const;
};

/// Reads one block of the file's own tiling, so that threads do not wait for each other. Throws Error{input}
/// if the file is damaged.
Block read_block(GDALDataset& dataset, const RasterHeader& header, int block_column, int block_row);

/// A number that is no height of any body (kMinHeight, kMaxHeight).
struct ImplausibleCells {
  std::int64_t count = 0;
  std::size_t first = 0;  ///< index in the block
  double height = 0;      ///< of the first, metres
};

/// Counts them among `count` cells of the block, beginning at `first`.
ImplausibleCells implausible_cells(const Block& block, std::size_t first, std::size_t count,
                                   const HeightScale& scale);

/// Sets those cells of `into` that have no height yet from the cells of the block, beginning at `first`.
/// Implausible heights are left out.
void copy_heights(const Block& block, std::size_t first, const HeightScale& scale, std::span<double> into);

}  // namespace waymark::importers
