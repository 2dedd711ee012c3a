// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include "core/grid.hpp"
#include "geo/canopy_source.hpp"
namespace waymark::pipeline {

/// Integer sums of laser returns about the centre of a cell; x, y, z in mm. Exact, so the order of the
/// returns does not matter.
struct CellSums {
  std::int32_t count = 0, x = 0, y = 0;
  std::int64_t z = 0, xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;
};

/// What the returns of a cell say of roofs.
struct RoofCell {
  CellSums high;             ///< last returns above min_height near the highest of them, without vegetation
  std::int32_t low = 0;      ///< last returns below it: the ground is seen
  std::int32_t plant = 0;    ///< last returns above it that are classified as vegetation
  std::int32_t split = 0;    ///< first returns above it whose pulse has several returns
  std::int32_t pulses = 0;   ///< first returns above it whose pulse states its number of returns
  std::int32_t classed = 0;  ///< of `high`: classified as building
};

/// Cells of one side that cover a window of a survey; each is `step` x `step` cells of the survey.
struct RoofCells {
  std::int64_t step = 1;
  Window window = {};             ///< in cells of this grid; (0, 0) begins at cell (0, 0) of the survey
  double width = 1, height = 1;   ///< of a cell, m
  double cell_x = 1, cell_y = 1;  ///< of a cell of the survey, m
  Grid<RoofCell> cells = {};      ///< of the window
  double density = 0;             ///< first returns per m2; 0: a raster

  /// Returns the centre of a cell of the window, metres from the centre of cell (0, 0) of the survey.
  Eigen::Vector2d centre(std::int64_t column, std::int64_t row) const {
    const auto middle = [&](std::int64_t k) {
      return static_cast<double>(k * step) + static_cast<double>(step - 1) / 2;
    };
    return {middle(window.column + column) * cell_x, -middle(window.row + row) * cell_y};
  }
  /// Returns the cell of the window, perhaps outside, of a position.
  std::array<std::int64_t, 2> cell_of(double x, double y) const;
};

/// Returns the side of roof cells in cells of a survey: 0.5 m, or one cell where cells are wider.
std::int64_t roof_cell_step(const GridGeometry& grid);

/// Sums the returns of a window, given in roof cells. Returns far below the highest last one of their cell
/// are on walls and are left out. Reads the window twice. Throws Error if a file is damaged.
RoofCells sum_roof_cells(const CanopySource& canopy, const Window& window, double min_height);

}  // namespace waymark::pipeline
