// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include "core/feature.hpp"
namespace waymark {

/// Multiplicity-based confidence q_# (Rossmann et al., eq. 5): seen / visible, in [0, 1].
/// `seen`: images that detected the landmark; `visible`: images that cover it and are at least as fine as the
/// coarsest that detected it (eq. 4). Absent where no image could have shown it.
std::optional<double> multiplicity_confidence(int seen, int visible);

/// How the spread of a feature becomes a confidence.
enum class SpreadRule {
  sound,  ///< ratio: 1 - s/|mean|; interval and axis: 1 - s/reference. One observation gives nothing.
  paper,  ///< eqs. 6-7 literally: 1 - s/mean, whatever the scale. One observation: s = 0, confidence 1.
};

/// Variance-based confidence q_f (eqs. 6-7), in [0, 1].
/// `reference` is the spread at which an interval or axis feature carries no information, > 0, in the
/// feature's unit (for an axis: pi/4 radians, the spread of random directions is about that). Departure: eq.
/// 6 divides by the mean, which is meaningless for elevations (mean near 0 or negative). Absent if the spread
/// is unknown (fewer than two observations) under `sound`; under `paper` absent where the mean is 0 and the
/// spread is not.
std::optional<double> spread_confidence(const FeatureValue& feature, Scale scale, double reference,
                                        SpreadRule rule = SpreadRule::sound);

/// Landmark quality q (eq. 8): q_# times the weighted mean of the q_f. Weights need not sum to 1: they are
/// normalised over the features whose confidence is known; a missing q_f neither helps nor hurts.
/// With no q_f known the quality is q_#; with q_# absent it is absent.
/// `of_feature` and `weights` have one entry per feature; weights >= 0.
std::optional<double> landmark_quality(std::optional<double> multiplicity,
                                       std::span<const std::optional<double>> of_feature,
                                       std::span<const double> weights);

}  // namespace waymark
