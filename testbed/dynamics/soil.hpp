// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "core/options.hpp"
#include "core/units.hpp"
namespace waymark::testbed {

/// Soil under a wheel. Defaults: lunar regolith (Carrier, Olhoeft & Mendell 1991, Lunar Sourcebook, chapter
/// 9), without the cohesive part of its modulus of sinkage.
struct Soil {
  Degrees friction{35};         ///< angle of internal friction
  double cohesion = 170;        ///< Pa
  double stiffness = 8.2e5;     ///< N/m^3, pressure per sinkage (Bekker's law with exponent 1)
  double shear_length = 0.018;  ///< m, of shear at which 63 % of the shear strength is reached (Janosi)
  double rock_friction = 0.8;   ///< coefficient between a wheel and a rock

  void describe(OptionVisitor& option);
};

/// Where a rigid wheel on soil or rock bears its load.
struct WheelFooting {
  double sinkage = 0;         ///< m; 0 on rock
  double contact_length = 0;  ///< m
  double resistance = 0;      ///< N against rolling: the work of compacting the soil (Bekker)
  double strength = 0;        ///< N, largest shear force
  double shear_length = 0;    ///< m
};

/// Returns the footing of a wheel of `radius` and `width` metres that bears `load` newtons. The contact is a
/// chord of the rim at depth `sinkage`: load = 2/3 stiffness width sinkage sqrt(2 radius sinkage).
WheelFooting wheel_footing(const Soil& soil, double load, double radius, double width, bool on_rock);

/// Returns the fraction of the shear strength that a shear displacement mobilizes: that of Janosi & Hanamoto
/// (1961), averaged over a contact in which the displacement grows from 0 to `displacement` metres.
double mobilized_fraction(double displacement, double shear_length);

/// Returns the slip of a wheel that pulls with a fraction of its strength: 1 - speed over ground / speed of
/// the rim. 1 if it pulls with all of it or more. The inverse of mobilized_fraction() over a rolling contact.
double slip_of_pull(double fraction, const WheelFooting& footing);

}  // namespace waymark::testbed
