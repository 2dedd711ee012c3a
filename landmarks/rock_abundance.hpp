// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <span>
namespace waymark::inline landmarks {

/// Height of a rock over its diameter on average (Golombek & Rapp 1997).
inline constexpr double kRockHeightPerDiameter = 0.5;
/// Its standard deviation among rocks; an assumption for maps that do not measure it.
inline constexpr double kRockHeightPerDiameterSd = 0.15;

/// Returns the number of rocks per square metre of diameters from `min_diameter` to `max_diameter` metres.
/// Their cumulative fractional area is k exp(-(1.79 + 0.152 / k) D) (Golombek & Rapp 1997); k is the fraction
/// of the terrain that rocks cover, in (0, 1].
double rocks_per_square_metre(double k, double min_diameter,
                              double max_diameter = std::numeric_limits<double>::infinity());

/// Fraction of the terrain covered by rocks, fitted to a count.
struct RockCover {
  double k = 0, sd = 0;
};

/// Returns the k for which `count` rocks wider than `diameter` metres are expected on `area` square metres.
/// The sd is that of the count (Poisson). k is at most 0.6.
RockCover fit_rock_cover(std::int64_t count, double diameter, double area);

/// Returns the diameter from which rocks are detected completely: the lower edge of the fullest bin of the
/// logarithm of their diameters, in bins of a factor 2^(1/4); NaN for fewer than 20 rocks.
double completeness_diameter(std::span<const double> diameters);

}  // namespace waymark::inline landmarks
