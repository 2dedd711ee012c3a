// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string_view>
namespace waymark {

/// How evidence adds up to a probability. Images share what deceives a detector (light, shape, albedo), so
/// further detections count less than the first; an image that could have shown a landmark and did not counts
/// against it.
struct ExistenceRules {
  double further_detection = 0.3;  ///< share of the log odds of a detection beyond the best
  double missed_image = 0.7;       ///< log odds taken away by an image that should have shown it
  double doubt = 0;                ///< log odds taken away from all: what deceives every image alike
  double least = 0;                ///< a landmark less probable than this is none
};

/// By likelihood on testbed landings (docs/qualities.md): what is mistaken for a rock is mistaken in every
/// image, and one that more probably is none is left out; craters are often missed, and where a DEM is known
/// all their observations share its evidence. Other types: the defaults.
ExistenceRules existence_rules(std::string_view type);

/// Probability that a landmark exists, from the confidences of its observations, each in (0, 1], and the
/// number of images that covered it in vain: logit p = best + share x sum of the others - missed x misses -
/// doubt.
double existence_probability(std::span<const double> confidences, int missed,
                             const ExistenceRules& rules = {});

}  // namespace waymark
