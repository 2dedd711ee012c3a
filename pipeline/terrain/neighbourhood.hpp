// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
namespace waymark::pipeline {

/// Step from a cell to one of its neighbours.
struct NeighbourStep {
  int column, row;
};
/// The eight neighbours, clockwise from north; bit i of a mask stands for kRing[i].
inline constexpr std::array<NeighbourStep, 8> kRing{
    {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}}};

/// Returns one neighbour of each connected part of the neighbours in `mask`, as a mask. Neighbours are
/// connected if they touch by an edge or a corner (8-connectivity), e.g. north and east.
/// 0 parts: local maximum; 1: slope; 2 to 4: saddle.
std::uint8_t connected_parts(std::uint8_t mask);

/// Computes for a row of cells which neighbours are higher in the order of cell_order.hpp.
/// `north`, `here`, `south` point at the first cell; the cells before it and after the last must be readable.
/// Earlier neighbours in row order win ties.
void higher_neighbours(const double* north, const double* here, const double* south,
                       std::span<std::uint8_t> masks);

}  // namespace waymark::pipeline
