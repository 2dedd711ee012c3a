// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
namespace waymark {

/// The one order of cells that all of prominence rests on: higher first, and among equals the smaller index
/// of the whole grid first. No two cells are equal in it, so each summit has one key saddle and one parent,
/// and nothing depends on tiles, threads or the order of files.
constexpr bool is_higher(double height_a, std::int64_t cell_a, double height_b, std::int64_t cell_b) {
  return height_a != height_b ? height_a > height_b : cell_a < cell_b;
}

}  // namespace waymark
