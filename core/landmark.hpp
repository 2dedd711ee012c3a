// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>
#include "core/attribute.hpp"
#include "core/feature.hpp"
#include "core/frames.hpp"
#include "core/observation.hpp"
namespace waymark::inline core {

/// Quality of the observations of a landmark: counts, and one confidence per feature.
struct Quality {
  int seen = 0;     ///< images (or surveys) that detected it
  int visible = 0;  ///< images (or surveys) that could have detected it
  /// q_f (eq. 7) per feature; `std::nullopt` for features with a single observation.
  std::vector<std::optional<double>> feature_confidences;
};

/// Landmark of a map: merged from its observations, with covariance, features and quality.
struct Landmark {
  std::string uid;  ///< stable over runs, tiles and threads; see landmarks/uid.hpp
  TypeId type = 0;
  Point<MapCrs> position;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< east, north, up; square metres
  FeatureSet features;                                   ///< in the order of the type's features
  AttributeSet attributes;                               ///< in the order of the type's attributes
  Quality quality;
  double confidence = 1;  ///< probability that the landmark exists, [0, 1]
  int observations = 1;
};

}  // namespace waymark::inline core
