// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cassert>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>
namespace waymark::inline core {

/// Rectangle of cells: columns [column, column + columns), rows [row, row + rows). May extend beyond a grid.
struct Window {
  std::int64_t column = 0, row = 0;
  std::int64_t columns = 0, rows = 0;

  std::int64_t cells() const { return columns * rows; }
  std::int64_t end_column() const { return column + columns; }
  std::int64_t end_row() const { return row + rows; }
  bool contains(std::int64_t c, std::int64_t r) const {
    return c >= column && c < end_column() && r >= row && r < end_row();
  }
  friend bool operator==(const Window&, const Window&) = default;
};

/// Raster of cells in memory, row by row from the top. Rows and columns count from 0.
template <class T>
class Grid {
 public:
  Grid() = default;
  Grid(std::int64_t columns, std::int64_t rows, T fill = T{})
      : columns_(columns), rows_(rows), cells_(static_cast<std::size_t>(columns * rows), fill) {}

  std::int64_t columns() const { return columns_; }
  std::int64_t rows() const { return rows_; }
  bool contains(std::int64_t column, std::int64_t row) const {
    return column >= 0 && column < columns_ && row >= 0 && row < rows_;
  }

  /// Returns a cell, unchecked in release builds; `at` throws std::out_of_range.
  T& operator()(std::int64_t column, std::int64_t row) { return cells_[index(column, row)]; }
  const T& operator()(std::int64_t column, std::int64_t row) const { return cells_[index(column, row)]; }
  const T& at(std::int64_t column, std::int64_t row) const {
    if (!contains(column, row))
      throw std::out_of_range("cell (" + std::to_string(column) + ", " + std::to_string(row) +
                              ") is outside a grid of " + std::to_string(columns_) + " x " +
                              std::to_string(rows_));
    return cells_[index(column, row)];
  }

  std::span<T> row(std::int64_t r) { return std::span<T>(cells_).subspan(index(0, r), width()); }
  std::span<const T> row(std::int64_t r) const {
    return std::span<const T>(cells_).subspan(index(0, r), width());
  }
  std::span<T> cells() { return cells_; }
  std::span<const T> cells() const { return cells_; }

  friend bool operator==(const Grid&, const Grid&) = default;

 private:
  std::size_t width() const { return static_cast<std::size_t>(columns_); }
  std::size_t index(std::int64_t column, std::int64_t row) const {
    assert(columns_ == 0 || contains(column, row));
    return static_cast<std::size_t>(row * columns_ + column);
  }

  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<T> cells_;
};

}  // namespace waymark::inline core
