// SPDX-License-Identifier: Apache-2.0
#include "testbed/dynamics/soil.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::testbed {
namespace {

constexpr double kRockContact = 0.03;     // m, length of the contact of a grouser wheel on rock
constexpr double kRockShear = 0.002;      // m
constexpr double kRockResistance = 0.02;  // fraction of the load
constexpr double kMaxSinkage = 0.5;       // of the radius: the law holds for shallow wheels only

}  // namespace

void Soil::describe(OptionVisitor& option) {
  option("friction", friction, {.help = "Angle of internal friction of the soil", .min = 5, .max = 60});
  option("cohesion", cohesion, {.help = "Cohesion of the soil, pascal", .min = 0, .max = 1e6});
  option("stiffness", stiffness, {.help = "Pressure per metre of sinkage, pascal", .min = 1e4, .max = 1e9});
  option("shear_length", shear_length,
         {.help = "Shear at which 63 % of the strength is reached, metres", .min = 1e-3, .max = 1});
  option("rock_friction", rock_friction,
         {.help = "Coefficient of friction between wheels and rocks", .min = 0.05, .max = 2});
}

WheelFooting wheel_footing(const Soil& soil, double load, double radius, double width, bool on_rock) {
  load = std::max(0.0, load);
  if (on_rock)
    return {.contact_length = kRockContact,
            .resistance = kRockResistance * load,
            .strength = soil.rock_friction * load,
            .shear_length = kRockShear};
  const double depth = std::pow(1.5 * load / (soil.stiffness * width * std::sqrt(2 * radius)), 2.0 / 3.0);
  WheelFooting footing;
  footing.sinkage = std::min(depth, kMaxSinkage * radius);
  footing.contact_length = std::sqrt(2 * radius * footing.sinkage);
  footing.resistance = width * soil.stiffness * footing.sinkage * footing.sinkage / 2;
  footing.strength =
      load * std::tan(to_radians(soil.friction).value) + soil.cohesion * width * footing.contact_length;
  footing.shear_length = soil.shear_length;
  return footing;
}

double mobilized_fraction(double displacement, double shear_length) {
  const double x = std::abs(displacement) / shear_length;
  if (x < 1e-4) return x / 2;  // the difference below would lose its digits
  return 1 - (1 - std::exp(-x)) / x;
}

double slip_of_pull(double fraction, const WheelFooting& footing) {
  if (!(fraction > 0)) return 0;
  if (fraction >= mobilized_fraction(footing.contact_length, footing.shear_length)) return 1;
  double low = 0, high = footing.contact_length;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = (low + high) / 2;
    (mobilized_fraction(middle, footing.shear_length) < fraction ? low : high) = middle;
  }
  return low / footing.contact_length;
}

}  // namespace waymark::testbed
