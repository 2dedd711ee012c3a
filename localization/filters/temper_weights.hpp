// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
namespace waymark::localization {

/// Weights after a tempered update, and the exponent used.
struct TemperedWeights {
  double exponent = 0;          ///< of the likelihood
  std::vector<double> weights;  ///< weights times exp(exponent fit); they sum to 1
};

/// Applies the largest likelihood exponent in [0, most] that keeps the effective sample size at or above
/// `least`. `fit` holds log likelihoods; the weights sum to 1. If the exponent is less than `most`, the
/// effective size is at most 2 % above `least`. Passes over the particles three to six times.
TemperedWeights temper_weights(std::span<const double> weights, std::span<const double> fit, double most,
                               double least);

}  // namespace waymark::localization
