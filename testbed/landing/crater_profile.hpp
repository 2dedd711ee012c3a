// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
namespace waymark::testbed {

/// Height profile of a crater over its radius, from fresh to almost erased.
/// - Degradation: diffusion of a fresh bowl (landmarks/crater_degradation.hpp), solved once.
/// - Lengths are in diameters of the *degraded* rim crest, which moves outwards with age: r = 0.5 is always
///   the crest.
class CraterProfiles {
 public:
  CraterProfiles();
  static const CraterProfiles& instance();

  static constexpr double kFreshDepth = 0.2;
  static constexpr double kReach = 2.4;  ///< diameters; beyond, the height is 0

  /// Returns the age kappa t / R^2 at which depth / diameter has fallen to `depth`; 0 for kFreshDepth and
  /// above.
  double age(double depth) const;
  /// Returns the height above the plain, in diameters, at r diameters from the centre.
  double height(double age, double r) const;
  double depth(double age) const;  ///< rim crest to floor, in diameters

 private:
  double row_of(double age) const;

  std::vector<double> ages_, depths_;
  std::vector<std::vector<float>> heights_;  ///< per age, kPerDiameter samples per diameter
};

}  // namespace waymark::testbed
