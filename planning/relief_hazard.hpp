// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "planning/base_fit.hpp"
#include "planning/vehicle.hpp"
namespace waymark::planning {

/// Errors of the heights of a DEM.
struct HeightErrors {
  double sd = 0;           ///< metres, of a height; 0: none
  double correlation = 0;  ///< metres, distance at which the correlation of two errors has fallen to 1/e
};

/// Effects of the errors of the heights on a fit of the base: constants of the footprint.
struct FitErrors {
  double spread_x = 0, spread_y = 0;  ///< square metres, sums of x^2 and y^2 over the disc
  double unresolved = 0;              ///< fraction of the base's mean square relief that lies within a cell
  double variance_x = 0, variance_y = 0;  ///< of the plane's gradient
  double mean_square = 0;                 ///< square metres, expected square of the residuals
  double mean_square_sd = 0;              ///< square metres, of that square in one base
  double freedom = 1;                     ///< number of independent errors in the base
  double step_sd = 0;                     ///< metres, of the difference of two heights a step apart
  double step_bias = 0;  ///< metres, expected largest difference in the box from errors alone
};
FitErrors propagate_errors(const BaseFootprint& base, const HeightErrors& errors);

/// Value with its standard deviation.
struct Uncertain {
  double value = 0, sd = 0;
};

/// Relief under a vehicle's base, and the probability that it exceeds the vehicle's limits.
struct ReliefHazard {
  Uncertain slope;      ///< degrees, of the fitted plane
  Uncertain roughness;  ///< metres, root mean square about the plane, less that of the errors
  Uncertain step;       ///< metres, largest change of height over a wheel's diameter, less that of the errors
  double probability = 0;
};

/// Returns the hazard of one cell; NaN where the relief is. The probabilities of slope, roughness and step
/// are combined as if they were independent, which errs on the safe side.
ReliefHazard assess_relief(const BaseRelief& relief, const FitErrors& errors, const Vehicle& vehicle);

/// Returns the probability that a Gaussian value exceeds a limit, to 2e-6; 0 or 1 for sd = 0.
double probability_above(const Uncertain& value, double limit);

}  // namespace waymark::planning
