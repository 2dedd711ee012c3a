// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
namespace waymark {

/// The eight neighbours, clockwise from north; bit i of a mask stands for kRing[i].
struct NeighbourStep {
  int column, row;
};
inline constexpr std::array<NeighbourStep, 8> kRing{
    {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}}};

/// Of the neighbours in `mask`, the connected parts: one neighbour of each, as a mask. Two neighbours are
/// connected if they touch by an edge or a corner (8-connectivity), e.g. north and east.
/// 0 parts: the cell is a local maximum; 1: a slope; 2 to 4: a saddle.
std::uint8_t one_of_each_part(std::uint8_t mask);

/// For a row of cells, which neighbours are higher in the order of cell_order.hpp. `north`, `here`, `south`
/// point at the first cell; the cells before it and after the last must be readable. Neighbours that come
/// before in row order win ties.
void higher_neighbours(const double* north, const double* here, const double* south,
                       std::span<std::uint8_t> masks);

}  // namespace waymark
