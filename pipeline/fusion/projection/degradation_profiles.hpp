// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
namespace waymark::pipeline {

/// Radial profiles of craters from fresh to almost erased.
/// Diffusion of a fresh bowl (landmarks/crater_degradation.hpp), as in the testbed. Diffusion is a Gaussian
/// filter, so averaging over DEM cells only adds to its width.
class DegradationProfiles {
 public:
  DegradationProfiles();
  static const DegradationProfiles& instance();

  /// State of degradation. Lengths in radii of the fresh crater.
  struct State {
    double depth;  ///< crest to floor, in diameters of the worn crest
    double blur;   ///< standard deviation of the Gaussian
    double crest;  ///< radius of the highest point of the rim
    /// ln(crest / edge); the edge is the sharpest bend of the profile, where brightness changes fastest.
    double crest_over_edge;
  };
  /// Returns the states by depth, deepest first, from 0.2 down to 0.02.
  const std::vector<State>& states() const { return states_; }

  /// Returns the height, in diameters of the fresh crater, at r of its radii, smoothed by `blur` radii.
  double height(double blur, double r) const;

 private:
  std::vector<double> blurs_;
  std::vector<std::vector<float>> heights_;  ///< per blur
  std::vector<State> states_;
};

}  // namespace waymark::pipeline
