// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
namespace waymark::pipeline {

/// Matching cost of each height step at each node; steps fastest, then columns.
struct CostVolume {
  int columns = 0, rows = 0, steps = 0;
  std::vector<std::uint8_t> cost = {};

  std::size_t at(int column, int row) const {
    return (static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
            static_cast<std::size_t>(column)) *
           static_cast<std::size_t>(steps);
  }
};

/// Penalties between neighbours of a path.
struct PathPenalties {
  int small = 4;   ///< for a change of one step
  int large = 24;  ///< for any larger change
};

/// Returns the costs summed over 8 paths in the layout of the volume: semi-global matching (Hirschmueller
/// 2008, eqs. 13, 14). Steps count from a base surface, so a slope of that surface costs nothing. O(nodes x
/// steps x 8).
std::vector<std::uint16_t> sum_path_costs(const CostVolume& volume, const PathPenalties& penalties);

}  // namespace waymark::pipeline
