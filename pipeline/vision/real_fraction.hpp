// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
namespace waymark::pipeline {

/// Fractions of the detections in an image that have a property of real objects.
struct PropertyLimits {
  double alien = 0;  ///< at most this on ground that the detector was not made for
  double usual = 1;  ///< at least this among real objects, > alien
};

/// Returns an upper estimate of the fraction of `count` detections that can be real, [0.02, 1], if `with` of
/// them have the property. It is 1 for fewer than 30: so few allow no statement.
double real_fraction(std::int64_t with, std::int64_t count, const PropertyLimits& limits);

/// Shifts the log odds of all `probabilities` so that their sum is `fraction` of what it was. A fraction of 1
/// or more changes nothing. O(n).
void lower_to_fraction(std::span<double> probabilities, double fraction);

}  // namespace waymark::pipeline
