// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "core/attribute.hpp"
#include "core/feature.hpp"
#include "core/frames.hpp"
#include "core/observation.hpp"
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

/// Quality of the observations of a landmark: counts, and one confidence per feature.
struct Quality {
  int seen = 0;     ///< images (or surveys) that detected it
  int visible = 0;  ///< images (or surveys) that could have detected it
  /// q_f (eq. 7) per feature; `std::nullopt` for features with a single observation.
  std::vector<std::optional<double>> feature_confidences;
};

/// Landmark of a map: merged from its observations, with covariance, features and quality.
struct Landmark {
  std::string uid;  ///< stable over runs, tiles and threads; see assign_uids
  TypeId type = 0;
  Point<MapCrs> position;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y of the map CRS, up; square metres
  FeatureSet features;                                   ///< in the order of the type's features
  AttributeSet attributes;                               ///< in the order of the type's attributes
  Quality quality;
  double confidence = 1;  ///< probability that the landmark exists, [0, 1]
  int observations = 1;
};

}  // namespace waymark::inline core
