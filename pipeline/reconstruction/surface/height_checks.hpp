// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "core/grid.hpp"
namespace waymark::pipeline {

/// Returns the cells off the plane of their neighbours: those of 7 x 7, planes fitted by iterated weights
/// (Huber), farther than `limit` standard deviations of the residuals and of the cell. A cell on an edge
/// stays where four of its eight neighbours agree with it. `sd` is of the heights; NaN heights are unknown.
Grid<std::uint8_t> cells_off_plane(const Grid<float>& heights, const Grid<float>& sd, double limit);

/// Returns the cells of patches of at most `max_cells` cells. Neighbours, by sides, belong to one patch if
/// their heights differ by at most `max_step` metres.
Grid<std::uint8_t> cells_of_islands(const Grid<float>& heights, std::int64_t max_cells, double max_step);

}  // namespace waymark::pipeline
