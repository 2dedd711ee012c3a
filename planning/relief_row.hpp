// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "planning/relief_hazard.hpp"
namespace waymark::planning {

/// Assesses rows of cells as assess_relief() does single ones, several cells at a time: the same bits.
class ReliefRow {
 public:
  ReliefRow(const FitErrors& errors, const Vehicle& vehicle) : errors_(errors), vehicle_(vehicle) {}

  /// Values and standard deviations of a row; each is as long as the row.
  struct Bands {
    std::span<float> slope, slope_sd, roughness, roughness_sd, step, step_sd;
  };
  /// Fills the bands, with NaN where the step is. Returns the probabilities, valid until the next call; any
  /// value where the step is NaN.
  std::span<const double> assess(std::span<const BaseRelief> relief, const Bands& bands);

 private:
  const FitErrors& errors_;
  const Vehicle& vehicle_;
  std::vector<double> slope_, slope_sd_, probability_;
};

}  // namespace waymark::planning
