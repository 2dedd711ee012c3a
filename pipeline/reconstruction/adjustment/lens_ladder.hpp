// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "pipeline/reconstruction/adjustment/adjust.hpp"
namespace waymark::pipeline {

/// Decision about one parameter of a lens.
struct LadderStep {
  std::size_t lens = 0;
  std::string parameter = {};
  bool admitted = false;
  double value = 0, sd = 0, prior_value = 0, prior_sd = 0;
  bool contradicts = false;          ///< admitted, although far from its prior: that was dropped
  double correlation = 0;            ///< largest, to a parameter already in
  std::string correlated_with = {};  ///< that parameter
  double left_out_before = 0, left_out_after = 0;  ///< residuals of left-out points, standard deviations
  std::string reason = {};                         ///< why it stays at its prior value; empty if admitted
};

struct LadderOptions {
  double max_sd = 0.3;  ///< of an admitted parameter, by that of its prior
  double max_correlation = 0.95;
  /// Of a term from its prior, in standard deviations, unless the residuals of left-out points fall
  /// by `min_fall` as well: unmodelled errors, such as those of a rolling shutter, move weakly determined
  /// terms.
  double max_deviation = 3;
  double min_fall = 0.3;
  std::function<void()> progress = {};  ///< after each group that is tried
};

struct CalibratedAdjustment {
  AdjustmentResult adjustment = {};
  std::vector<LadderStep> steps = {};
  std::vector<LensPrior> priors = {};  ///< used: those given, and defaults for the other parameters
};

/// Adjusts, with self-calibration: f, k1, k2, (cx, cy), (p1, p2) in this order; no p1, p2 for a fisheye.
/// - A group enters only if the data determine it and do not contradict what is known of it (LadderOptions).
/// - The residuals of left-out tie points must fall.
/// - The prior of an admitted parameter that it contradicts is widened to their difference.
/// Otherwise its parameters keep their values. `options.free_lens_parameters` are free from the start.
CalibratedAdjustment adjust_with_ladder(Reconstruction& scene, const Observations& observations,
                                        AdjustmentOptions options = {}, const LadderOptions& ladder = {});

/// Returns the number of groups that are tried for a camera if none is tried again.
std::size_t ladder_groups(const Camera& camera);

/// Returns the prior of a parameter when nothing is known: its value with a standard deviation. That is 10 %
/// for f, 2 % of the width for cx and cy, 0.2 for k1 to k4, 0.005 for p1 and p2.
LensPrior default_prior(const Camera& camera, std::size_t lens, const std::string& parameter, double value);

}  // namespace waymark::pipeline
