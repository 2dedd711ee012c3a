// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "pipeline/buildings/roof_plane.hpp"
namespace waymark::pipeline {

/// Limits of roofs. Metres and square metres.
struct RoofRules {
  double min_height = 2.5;       ///< of a return above the ground
  double min_area = 12;          ///< of a building's footprint
  double max_extent = 150;       ///< of a connected group of roofs along the axes of the grid
  double roughness = 0.15;       ///< root mean square distance of the returns from their plane
  double min_plane_area = 4;     ///< of a plane
  double max_penetration = 0.3;  ///< fraction of pulses that pass a roof or split on it; trees have more
  double min_confidence = 0.3;
  friend bool operator==(const RoofRules&, const RoofRules&) = default;
};

/// Cell of a window.
struct RoofCellAt {
  std::int64_t column = 0, row = 0;
  friend bool operator==(const RoofCellAt&, const RoofCellAt&) = default;
};

/// Connected planes of a roof.
struct RoofRegion {
  std::vector<RoofPlane> planes;
  std::vector<std::vector<RoofCellAt>> plane_cells;  ///< of each plane
  std::vector<RoofCellAt> cells;  ///< of all planes and the cells enclosed by them, by row, then column
  double rough_cells = 0;         ///< cells near the planes with returns on none, per cell of the planes
};

/// Connected smooth cells and what was found on them.
struct RoofGroup {
  Window box = {};   ///< cells of the window
  bool cut = false;  ///< reaches the margin of the window, where cells lack neighbours
  std::vector<RoofRegion> regions = {};
};

/// Returns the number of cells at the edges of a window within which groups are not complete.
std::int64_t roof_margin(const RoofCells& cells);

/// Finds planes by surface growing (Vosselman et al. 2004) on cells.
/// - A cell is smooth if the returns of its neighbourhood of about 2.5 m lie on a plane within `roughness`.
/// - Smooth cells and those near them form groups. In each group planes grow from the smoothest cell, and
///   adjacent planes form a region.
/// - A group depends on its cells alone, so it is the same in every window that holds it.
/// Departure: no Hough transform; seeds are local fits. About 1 us per cell.
std::vector<RoofGroup> find_roof_groups(const RoofCells& cells, const RoofRules& rules);

}  // namespace waymark::pipeline
