// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string_view>
#include <vector>
#include "landmarks/semantic_map.hpp"
#include "localization/identification/known_features.hpp"
namespace waymark::localization {

/// Key of a landmark: 64 bits of a hash of its uid.
using LandmarkKey = std::uint64_t;
/// Returns the key of a uid.
LandmarkKey landmark_key(std::string_view uid);

/// A landmark as localization uses it: in the plane of the map frame, metres. Covariance and directions are
/// along east and north of the frame, not along the axes of the map's CRS.
struct MapLandmark {
  LandmarkKey key = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of `at`, m^2
  TypeId type = 0;
  /// Probability that it exists, (0, 1]: the map's confidence, or its quality if it has none. 1 without both.
  double quality = 1;
  /// For the sensor (eq. 8), (0, 1]; kUnassessedQuality if its observations say nothing, 1 if the map has no
  /// counts at all.
  double paper_quality = 1;
  KnownFeatures features;
  double diameter = 0;  ///< m, of its body; 0: unknown
};

/// Quality of a landmark that was observed but not assessed, the mean of a quality that may be anything. With
/// 1, which eq. 7 gives to a single observation, it would outrank every landmark that images agree on.
inline constexpr double kUnassessedQuality = 0.5;

/// Converts all landmarks of a map. `sensor`: profile for eq. 8; null: equal weights.
std::vector<MapLandmark> to_map_landmarks(const SemanticMap& map, const SensorProfile* sensor = nullptr);

/// Converts one landmark.
MapLandmark map_landmark(const Landmark& landmark, const LandmarkType& type, const LocalFrame& frame,
                         const SensorProfile* sensor = nullptr);

}  // namespace waymark::localization
