// SPDX-License-Identifier: Apache-2.0
#pragma once
namespace waymark::localization {

/// Returns the probability that a chi-square variable with `freedom` >= 1 degrees of freedom is at most x.
/// Uses the series of the incomplete gamma function; accurate to 1e-12.
double chi_square_probability(double x, double freedom);

/// Returns the x that is not exceeded with probability p in (0, 1): 9.2103 for p = 0.99, freedom = 2.
/// Bisects, which takes about 10 us: compute it once, not for each landmark.
double chi_square_quantile(double p, double freedom);

}  // namespace waymark::localization
