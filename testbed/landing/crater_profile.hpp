// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
namespace waymark {

/// Height of a crater over its radius, from fresh to almost gone. A fresh bowl (depth / diameter 0.2, raised
/// rim 0.036, ejecta falling as r^-3; Pike 1977, Melosh 1989) is worn down by diffusion of the ground
/// (Soderblom 1970, Fassett & Thomson 2014), solved numerically once. Lengths in diameters of the *worn* rim
/// crest, which creeps outwards as the crater ages: r = 0.5 is always the crest.
class CraterProfiles {
 public:
  CraterProfiles();
  static const CraterProfiles& instance();

  static constexpr double kFreshDepth = 0.2;
  static constexpr double kReach = 2.4;  ///< diameters; beyond, the height is 0

  /// Age kappa t / R^2 at which depth / diameter has fallen to this; 0 for kFreshDepth and above.
  double age(double depth) const;
  /// Height above the plain, in diameters, at r diameters from the middle.
  double height(double age, double r) const;
  double depth(double age) const;  ///< rim crest to floor, in diameters

 private:
  double row_of(double age) const;

  std::vector<double> ages_, depths_;
  std::vector<std::vector<float>> heights_;  ///< per age, kPerDiameter samples per diameter
};

}  // namespace waymark
