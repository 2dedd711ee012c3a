// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include "core/grid.hpp"
namespace waymark::pipeline {

/// Numbers of smooth_by_planes().
struct PlaneSmoothing {
  std::array<double, 2> reach = {1.5, 2.5};  ///< radii of the neighbourhoods, cells
  double separation = 16;  ///< squared difference, in variances, beyond which neighbours do not count
  double shared = 4;       ///< cells that share an error of matching
};

/// Cells beyond which heights have no effect on a cell.
inline constexpr std::int64_t kSmoothingHalo = 7;

/// Smooths heights by local planes with adaptive weights (Polzehl & Spokoiny 2000). Each round counts the
/// neighbours whose former heights agree with the former plane within their errors, so that jumps stay.
/// Weights are 1 / sd^2. Cells without height stay so.
Grid<float> smooth_by_planes(const Grid<float>& heights, const Grid<float>& sd,
                             const PlaneSmoothing& rules = {});

}  // namespace waymark::pipeline
