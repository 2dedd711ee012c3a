// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/mosaic.hpp"

#include <algorithm>
#include <optional>

namespace waymark::importers {
namespace {

std::vector<std::string> paths_of(const std::vector<RasterHeader>& headers) {
  std::vector<std::string> paths;
  for (const RasterHeader& header : headers) paths.push_back(header.path);
  return paths;
}

bool has_voids(const HeightWindow& heights, const Window& part, const Window& window) {
  for (std::int64_t row = part.row; row < part.end_row(); ++row) {
    const auto cells = heights.row(row - window.row)
                           .subspan(static_cast<std::size_t>(part.column - window.column),
                                    static_cast<std::size_t>(part.columns));
    if (std::ranges::find(cells, kNoHeight) != cells.end()) return true;
  }
  return false;
}

}  // namespace

std::shared_ptr<const Block> BlockCache::get(const Key& key, const std::function<Block()>& read) {
  if (auto block = find(key)) return block;
  auto block = std::make_shared<const Block>(read());
  keep(key, block);
  return block;
}

std::shared_ptr<const Block> BlockCache::find(const Key& key) {
  const std::scoped_lock lock(mutex_);
  const auto found = places_.find(key);
  if (found == places_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->block;
}

void BlockCache::keep(const Key& key, std::shared_ptr<const Block> block) {
  const std::scoped_lock lock(mutex_);
  if (places_.contains(key)) return;  // another thread has added it
  used_ += block->bytes();
  entries_.push_front({key, std::move(block)});
  places_.emplace(key, entries_.begin());
  while (used_ > limit_ && entries_.size() > 1) {
    used_ -= entries_.back().block->bytes();
    places_.erase(entries_.back().key);
    entries_.pop_back();
  }
}

Window intersection(const Window& a, const Window& b) {
  const std::int64_t column = std::max(a.column, b.column), row = std::max(a.row, b.row);
  return {column, row, std::max<std::int64_t>(0, std::min(a.end_column(), b.end_column()) - column),
          std::max<std::int64_t>(0, std::min(a.end_row(), b.end_row()) - row)};
}

Mosaic::Mosaic(std::vector<RasterHeader> headers, std::size_t cache_bytes)
    : headers_(std::move(headers)),
      layout_(lay_out(headers_)),
      cache_(cache_bytes),
      handles_(paths_of(headers_)) {}

// Calls visit(block, first, count, column, row) for each row of each block of a file in `part`: `count` cells
// of the block from `first`, which lie in the grid at (column, row).
void Mosaic::for_each_row(std::size_t file, const Window& part, auto&& visit) const {
  if (part.cells() == 0) return;
  const RasterHeader& header = headers_[file];
  const Window& place = layout_.files[file];
  const std::int64_t wide = header.block_columns, tall = header.block_rows;
  const std::int64_t blocks_across = (header.columns + wide - 1) / wide;
  const auto turned = [&](std::int64_t row) { return header.south_up ? header.rows - 1 - row : row; };
  // The part in columns and rows of the file, last ones included.
  const std::int64_t left = part.column - place.column, right = left + part.columns - 1;
  const auto [top, bottom] =
      std::minmax({turned(part.row - place.row), turned(part.end_row() - 1 - place.row)});
  std::optional<RasterHandles::Lease> open;
  for (std::int64_t block_row = top / tall; block_row <= bottom / tall; ++block_row)
    for (std::int64_t block_column = left / wide; block_column <= right / wide; ++block_column) {
      const auto number = static_cast<std::uint64_t>(block_row * blocks_across + block_column);
      const auto block = cache_.get({static_cast<std::uint32_t>(file), number}, [&] {
        if (!open) open.emplace(handles_, file);
        return read_block(**open, header, static_cast<int>(block_column), static_cast<int>(block_row));
      });
      const Window held{block_column * wide, block_row * tall, wide, tall};
      const Window wanted = intersection(held, {left, top, right - left + 1, bottom - top + 1});
      for (std::int64_t row = wanted.row; row < wanted.end_row(); ++row)
        visit(*block, static_cast<std::size_t>((row - held.row) * wide + wanted.column - held.column),
              static_cast<std::size_t>(wanted.columns), place.column + wanted.column,
              place.row + turned(row));
    }
}

HeightWindow Mosaic::read(const Window& window) const {
  HeightWindow heights(window.columns, window.rows, kNoHeight);
  const Window whole{0, 0, grid().columns, grid().rows};
  if (!grid().wraps) {
    add_heights(intersection(window, whole), window, heights);
    return heights;
  }
  // Reads pieces between the wraps of the columns.
  for (std::int64_t column = window.column; column < window.end_column();) {
    const std::int64_t turn =
        column >= 0 ? column / whole.columns : -((whole.columns - 1 - column) / whole.columns);
    const std::int64_t shift = turn * whole.columns;
    const std::int64_t columns = std::min(window.end_column(), shift + whole.columns) - column;
    const Window seen{window.column - shift, window.row, window.columns, window.rows};
    add_heights(intersection({column - shift, window.row, columns, window.rows}, whole), seen, heights);
    column += columns;
  }
  return heights;
}

HeightWindow Mosaic::read_file(std::size_t file, const Window& window) const {
  HeightWindow heights(window.columns, window.rows, kNoHeight);
  add_file(file, window, window, heights);
  return heights;
}

// `inside`: the requested cells, all in the grid; `window`: the rows and columns of `heights`.
void Mosaic::add_heights(const Window& inside, const Window& window, HeightWindow& heights) const {
  bool first = true;
  for (std::size_t file = 0; file < headers_.size(); ++file) {
    const Window part = intersection(inside, layout_.files[file]);
    if (part.cells() == 0 || (!first && !has_voids(heights, part, window))) continue;
    add_file(file, part, window, heights);
    first = false;
  }
}

CellFaults Mosaic::implausible(const Window& window) const {
  CellFaults found;
  for (std::size_t file = 0; file < headers_.size(); ++file)
    for_each_row(
        file, intersection(window, layout_.files[file]),
        [&](const Block& block, std::size_t first, std::size_t count, std::int64_t column, std::int64_t row) {
          const auto cells = implausible_cells(block, first, count, headers_[file].heights);
          if (found.implausible == 0 && cells.count > 0) {
            found.height = cells.height;
            found.column = column + static_cast<std::int64_t>(cells.first - first);
            found.row = row;
          }
          found.implausible += cells.count;
        });
  return found;
}

void Mosaic::add_file(std::size_t file, const Window& part, const Window& window,
                      HeightWindow& heights) const {
  for_each_row(
      file, part,
      [&](const Block& block, std::size_t first, std::size_t count, std::int64_t column, std::int64_t row) {
        copy_heights(
            block, first, headers_[file].heights,
            heights.row(row - window.row).subspan(static_cast<std::size_t>(column - window.column), count));
      });
}

}  // namespace waymark::importers
