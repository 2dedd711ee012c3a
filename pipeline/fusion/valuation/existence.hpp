// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string_view>
namespace waymark::pipeline {

/// Weights of evidence for the existence of a landmark, in log odds.
/// Causes of false detections (light, shape, albedo) are common to images, so further detections count less
/// than the first.
/// An image that could have shown a landmark but did not counts against it.
struct ExistenceRules {
  double further_detection = 0.3;  ///< fraction of the log odds of each detection beyond the best
  double missed_image = 0.7;       ///< log odds subtracted per image that should have shown it
  double prior_penalty = 0;        ///< log odds subtracted from all: false detections common to images
  double min_probability = 0;      ///< landmarks less probable than this are removed
};

/// Returns the weights of a type, chosen by likelihood on testbed landings
/// (docs/evaluation/2026-11-22-existence-weights.md); defaults for other types.
/// - Rocks: false detections repeat in every image, and landmarks below 0.5 are removed.
/// - Craters: often missed, and with a DEM all observations share its evidence.
ExistenceRules existence_rules(std::string_view type);

/// Returns the probability that a landmark exists:
///   logit p = best + further_detection x sum of the others - missed_image x missed - prior_penalty.
/// `confidences` in (0, 1]; `missed` is the number of images that covered it without a detection.
double existence_probability(std::span<const double> confidences, int missed,
                             const ExistenceRules& rules = {});

}  // namespace waymark::pipeline
