// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
namespace waymark::pipeline {

/// Orders cells totally, as prominence needs: higher first, among equals the smaller grid index. No two cells
/// are equal, so each summit has one key saddle and one parent, independent of tiles, threads and the order
/// of files.
constexpr bool is_higher(double height_a, std::int64_t cell_a, double height_b, std::int64_t cell_b) {
  return height_a != height_b ? height_a > height_b : cell_a < cell_b;
}

}  // namespace waymark::pipeline
