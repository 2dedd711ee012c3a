// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
namespace waymark {

/// Craters from fresh to almost gone: a fresh bowl (depth / diameter 0.2, rim of 0.036 diameters, ejecta
/// falling as r^-3; Pike 1977, Melosh 1989), smoothed as diffusion of the ground smooths it (Soderblom 1970;
/// Fassett & Thomson 2014). Diffusion is a Gaussian, so the cells of a DEM only add to its width. The testbed
/// wears its craters by the same law.
class WornProfiles {
 public:
  WornProfiles();
  static const WornProfiles& instance();

  /// One wear. Lengths in radii of the fresh crater.
  struct Wear {
    double depth;  ///< crest to floor, in diameters of the worn crest
    double blur;   ///< standard deviation of the Gaussian
    double crest;  ///< where the worn rim is highest
    /// ln(crest / edge): the edge is where the ground bends most, so that brightness changes fastest.
    double crest_over_edge;
  };
  /// By depth, deepest first: 0.2 to 0.02 and less.
  const std::vector<Wear>& wears() const { return wears_; }

  /// Height in diameters of the fresh crater at r of its radii, smoothed by `blur` radii.
  double height(double blur, double r) const;

 private:
  std::vector<double> blurs_;
  std::vector<std::vector<float>> heights_;  ///< per blur
  std::vector<Wear> wears_;
};

}  // namespace waymark
