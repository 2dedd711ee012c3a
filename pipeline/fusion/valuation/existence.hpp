// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "landmarks/existence_rules.hpp"
namespace waymark::pipeline {

/// Returns the probability that a landmark exists:
///   logit p = best + further_detection x sum of the others - missed_image x missed - prior_penalty.
/// `confidences` in (0, 1]; `missed` is the number of images that covered it without a detection.
double existence_probability(std::span<const double> confidences, int missed,
                             const ExistenceRules& rules = {});

}  // namespace waymark::pipeline
