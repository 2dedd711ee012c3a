// SPDX-License-Identifier: Apache-2.0
#pragma once
namespace waymark::inline landmarks {

/// Weights of evidence for the existence of a landmark, in log odds.
/// Causes of false detections (light, shape, albedo) are common to images, so further detections count less
/// than the first.
/// An image that could have shown a landmark but did not counts against it.
struct ExistenceRules {
  double further_detection = 0.3;  ///< fraction of the log odds of each detection beyond the best
  double missed_image = 0.7;       ///< log odds subtracted per image that should have shown it
  double prior_penalty = 0;        ///< log odds subtracted from all: false detections common to images
  double min_probability = 0;      ///< landmarks less probable than this are removed
  friend bool operator==(const ExistenceRules&, const ExistenceRules&) = default;
};

}  // namespace waymark::inline landmarks
