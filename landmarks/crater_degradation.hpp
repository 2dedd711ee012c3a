// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
namespace waymark::inline landmarks {

/// Returns the height of a fresh simple crater above the plain, in diameters, at r radii from its centre:
/// depth / diameter 0.2, rim 0.036, ejecta falling as r^-3 (Pike 1977, Melosh 1989).
double fresh_crater_height(double r);

/// Radial profile of a crater whose surface diffuses (Soderblom 1970, Fassett & Thomson 2014):
/// dz/dt = (1/r) d/dr (r dz/dr), by explicit steps. Lengths in radii of the fresh crater, time in kappa t /
/// R^2. Diffusion over a time t is a Gaussian filter of standard deviation sqrt(2 t). Heights are accurate to
/// 1e-4 diameters at `reach` - 3 sqrt(2 t) and nearer; the slope at `reach` is 0.
class DiffusingCrater {
 public:
  static constexpr double kSpacing = 0.02;  ///< of the heights

  explicit DiffusingCrater(double reach);
  /// Diffuses until the first step at or after `time`.
  void advance_to(double time);
  double time() const { return time_; }
  /// Returns heights above the plain, in diameters of the fresh crater, from the centre outwards.
  const std::vector<double>& heights() const { return heights_; }

 private:
  std::vector<double> heights_, next_;
  double time_ = 0;
};

}  // namespace waymark::inline landmarks
