// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include "core/feature.hpp"
namespace waymark::inline core {

/// Computes the multiplicity-based confidence q_# = seen / visible in [0, 1] (Rossmann et al., eq. 5).
/// `seen` counts the images that detected the landmark. `visible` counts the images that cover it and are at
/// least as fine as the coarsest of those (eq. 4). `std::nullopt` if `visible` is 0.
std::optional<double> multiplicity_confidence(int seen, int visible);

/// Formula that converts the spread of a feature to a confidence.
enum class SpreadRule {
  sound,  ///< ratio: 1 - s/|mean|; interval and axis: 1 - s/reference. One observation: none.
  paper,  ///< eqs. 6-7 literally: 1 - s/mean, whatever the scale. One observation: s = 0, confidence 1.
};

/// Computes the variance-based confidence q_f in [0, 1] (eqs. 6-7).
/// - `reference`: spread at which an interval or axis feature carries no information, > 0, in the feature's
///   unit. For an axis pi/4 radians, about the spread of random axes.
/// - Departure: eq. 6 divides by the mean, which is meaningless for elevations (mean near 0 or negative).
/// - `sound`: `std::nullopt` for fewer than two observations. `paper`: `std::nullopt` if the mean is 0 and
///   the spread is not.
std::optional<double> spread_confidence(const FeatureValue& feature, Scale scale, double reference,
                                        SpreadRule rule = SpreadRule::sound);

/// Computes the landmark quality q (eq. 8): q_# times the weighted mean of the q_f.
/// - `feature_confidences` and `weights` have one entry per feature; weights are >= 0 and need not sum to 1.
/// - Features of unknown confidence are left out of the mean. Without any known q_f the quality is q_#.
/// - `std::nullopt` if q_# is unknown.
std::optional<double> landmark_quality(std::optional<double> multiplicity,
                                       std::span<const std::optional<double>> feature_confidences,
                                       std::span<const double> weights);

}  // namespace waymark::inline core
