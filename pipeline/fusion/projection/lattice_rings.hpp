// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
namespace waymark::pipeline {

/// Corner of a lattice cell: cell (c, r) has corners c..c+1, r..r+1.
struct LatticeCorner {
  std::int64_t column = 0, row = 0;
  friend bool operator==(const LatticeCorner&, const LatticeCorner&) = default;
};

/// Returns outlines of the marked cells as closed rings, clockwise with rows running down.
/// Cells that touch only at a corner are separate parts. Parts with holes are cut in two until none has any.
std::vector<std::vector<LatticeCorner>> lattice_rings(const Grid<std::uint8_t>& marked);

}  // namespace waymark::pipeline
