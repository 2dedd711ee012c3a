// SPDX-License-Identifier: Apache-2.0
#pragma once
namespace waymark::pipeline {

/// What the bias of a rock's position depends on. Lengths are pixels of the scale it was measured at.
struct PositionBiasInput {
  double radius = 2;         ///< of the rock
  double height = 1;         ///< above the ground
  double tan_elevation = 1;  ///< of the sun
  double displacement = 0;   ///< relief displacement along the light, away from the sun, per unit of height
};

/// Returns how far the network places rocks away from the sun on average, pixels; negative: towards the sun.
/// Regression on 120 views and 130 scenes that the network was not fitted to
/// (docs/evaluation/2026-11-23-boulders-and-rock-biases.md).
double position_bias(const PositionBiasInput& rock);

}  // namespace waymark::pipeline
