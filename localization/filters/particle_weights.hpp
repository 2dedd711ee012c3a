// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "core/options.hpp"
namespace waymark::localization {

/// Weights after a tempered update, and the exponent used.
struct TemperedWeights {
  double exponent = 0;          ///< of the likelihood
  std::vector<double> weights;  ///< weights times exp(exponent fit); they sum to 1
};

/// Applies the largest likelihood exponent in [0, `max_exponent`] that keeps the effective sample size at or
/// above `min_size`. `fit` holds log likelihoods; the weights sum to 1. If the exponent is less than
/// `max_exponent`, the effective size is at most 2 % above `min_size`. Passes over the particles three to six
/// times.
TemperedWeights temper_weights(std::span<const double> weights, std::span<const double> fit,
                               double max_exponent, double min_size);

/// Options of the weights of particles.
struct WeightOptions {
  /// `likelihood`: log of the probability of what was seen. `paper`: eqs. 12-14.
  std::string weights = "likelihood";
  /// `likelihood`: exponent of each sighting's likelihood, (0, 1]; below 1 for sightings with correlated
  /// errors.
  double temper = 0.5;
  /// `likelihood`: unseen landmarks in view count against a pose, by log(1 - q detection).
  bool expect_unseen = false;
  double detection = 0.7;                 ///< probability that a landmark of quality 1 in view is seen
  double view_range = 20;                 ///< m: range in which the sensor sees landmarks
  double view_angle = 6.283185307179586;  ///< rad: whole field of view about the sensor's x axis
  double gate = 0.9999;                   ///< probability that a right pairing passes
  /// `paper`: what a sighting without a landmark adds to eq. 12; negative: the gate. The paper's 0 makes a
  /// particle that matches nothing the best of all.
  double unmatched_cost = -1;

  void describe(OptionVisitor& option);
  /// Declares what `expect_unseen` reads, the last of describe().
  void describe_unseen(OptionVisitor& option);
};

/// Returns the weights of eqs. 13-14: (e_max - e) / e_max. If all errors are equal (also all 0, or e_max =
/// 0) every weight is 1.
std::vector<double> paper_weights(std::span<const double> errors);

/// Returns exp(log weight), scaled to sum 1. If none is above -infinity all are equal.
std::vector<double> normalise_log_weights(std::span<const double> log_weights);

}  // namespace waymark::localization
