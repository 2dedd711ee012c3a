// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "core/options.hpp"
namespace waymark {

/// How particles are weighed.
struct WeightOptions {
  /// `likelihood`: log of the probability of what was seen. `paper`: eqs. 12-14.
  std::string weights = "likelihood";
  double clutter = 0.003;  ///< `likelihood`: density of false sightings, per metre of range and radian
  /// `likelihood`: power of each sighting's probability, (0, 1]; below 1 for sightings whose errors are not
  /// independent of the last ones.
  double temper = 0.5;
  double quality_floor = 0.1;  ///< qualities below count as this; 1: quality is not used
  /// `likelihood`: landmarks in view that were not seen speak against a pose, by log(1 - q detection).
  bool expect_unseen = false;
  double detection = 0.7;                 ///< probability that a landmark of quality 1 in view is seen
  double view_range = 20;                 ///< m: how far the sensor sees landmarks
  double view_angle = 6.283185307179586;  ///< rad: its whole field of view about its x axis
  double gate = 0.9999;                   ///< beyond it a landmark cannot be the one seen
  /// `paper`: what a sighting without a landmark adds to eq. 12; negative: the gate. 0 is the paper's letter,
  /// with which a particle that matches nothing is the best of all.
  double unmatched_cost = -1;
  double feature_tolerance = 0.15;
  double feature_limit = 9;
  double bearing_reach = 100;  ///< m

  void describe(OptionVisitor& option);
};

/// Weights of eqs. 13-14 from errors: (e_max - e) / e_max. Degenerate cases: all errors equal (also all 0, or
/// e_max = 0) says nothing, every weight is 1.
std::vector<double> paper_weights(std::span<const double> errors);

/// exp(log weight), scaled so that they sum to 1. Where none is above -infinity all are equal.
std::vector<double> normalised(std::span<const double> log_weights);

}  // namespace waymark
