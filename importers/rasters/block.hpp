// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>
#include "importers/rasters/raster_header.hpp"
namespace waymark {

/// A decoded block of a file: `block_rows` rows of `block_columns` cells, in the file's order, unscaled.
/// Cells that a mask hides are NaN. Cells beyond the file's edge have any value.
struct Block {
  std::variant<std::vector<std::int16_t>, std::vector<float>, std::vector<double>> cells;

  std::size_t bytes() const;
};

/// Reads one block with the file's own compression unit, which no other thread's reading can hold up.
/// Throws Error{input} where the file is damaged.
Block read_block(GDALDataset& dataset, const RasterHeader& header, int block_column, int block_row);

/// Gives heights to those cells of `into` that have none yet, from the block's cells `first` and following.
void copy_heights(const Block& block, std::size_t first, const HeightScale& scale, std::span<double> into);

}  // namespace waymark
