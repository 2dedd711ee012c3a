// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
namespace waymark {

/// What weights become when as much of a set's fit is believed as they can bear.
struct Borne {
  double part = 0;              ///< of the fit
  std::vector<double> weights;  ///< weights times exp(part fit); they sum to 1
};

/// Believes the largest part in [0, most] of the log probabilities `fit` after which the weights, which sum
/// to 1, still count as at least `least` particles (`effective_count`); where that is less than `most`, they
/// then count as at most 2 % more. Three to six passes over the particles.
Borne believed(std::span<const double> weights, std::span<const double> fit, double most, double least);

}  // namespace waymark
