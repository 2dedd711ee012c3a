// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/ground_outline.hpp"
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

/// Returns true over shown depth of a crater `cells` of the terrain wide (at least 1) that shows a depth /
/// diameter of `shown`. Cells average over crest and floor, which takes a tenth of a fresh crater 5 cells
/// wide. The profile is that of DegradationProfiles with this shown depth; 1 for no depth.
double depth_growth(double shown, double cells);

/// Distance of a crater's crest outside its outline in an image.
struct CrestCorrection {
  double growth = 0;     ///< ln(crest / outline); negative where the outline lies outside
  double growth_sd = 0;  ///< from the ambiguity of the heights and the scatter of the law
};

/// Estimates the crest of a degraded crater from the terrain; the crest lies outside the steepest change of
/// brightness (docs/methods/craters.md).
/// - Heights on 13 ellipses (median of 36 azimuths, minus the plane of the surroundings) are compared with
///   DegradationProfiles of every depth, with crests about where the law has them.
/// - The growth is averaged over their likelihoods with a prior that favours deep craters, as images do.
/// - A terrain that does not resolve the crater is one of the hypotheses, with growth 0.
/// `std::nullopt` if the crater is narrower than three cells or heights around it are unknown.
std::optional<CrestCorrection> crest_correction(const Terrain& terrain, const GroundOutline& outline,
                                                double outline_edge_fraction);

}  // namespace waymark::pipeline
