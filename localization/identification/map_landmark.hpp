// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>
#include "landmarks/semantic_map.hpp"
#include "localization/identification/known_features.hpp"
namespace waymark::localization {

/// Key of a landmark: 64 bits of a hash of its uid.
using LandmarkKey = std::uint64_t;
/// Returns the key of a uid.
LandmarkKey landmark_key(std::string_view uid);

/// Probability of existence below which a landmark rather does not exist.
inline constexpr double kLikelyExistence = 0.5;

/// A landmark as localization uses it: in the plane of the map frame, metres. Covariance and directions are
/// along east and north of the frame, not along the axes of the map's CRS.
struct MapLandmark {
  LandmarkKey key = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of `at`, m^2
  TypeId type = 0;
  /// Probability that it exists, (0, 1]: the map's confidence, or its quality if it has none. 1 without both.
  double quality = 1;
  bool has_confidence = true;  ///< `quality` is the map's confidence
  /// For the sensor (eq. 8), (0, 1]; kUnassessedQuality if its observations say nothing, 1 if the map has no
  /// counts at all.
  double paper_quality = 1;
  /// It rather does not exist, and others nearby are expected to be most of those that do (LandmarkGrid).
  bool outweighed = false;
  KnownFeatures features;
  double diameter = 0;  ///< m, of its body; 0: unknown
  /// Of a line, such as a wall: unit vector across it to the side from which it is seen. 0: it is a point.
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  double half_length = 0;      ///< m, of a line
  double normal_variance = 0;  ///< rad^2

  bool is_line() const { return half_length > 0; }
  /// Returns whether it rather does not exist by its map. Lines and landmarks without a confidence never
  /// count as doubtful.
  bool is_doubtful() const { return quality < kLikelyExistence && has_confidence && !is_line(); }
  /// Returns the unit vector along a line, to the left of its normal.
  Eigen::Vector2d along() const { return {-normal.y(), normal.x()}; }
};

/// Features of a type whose landmarks are straight lines, such as walls: the direction of the normal and the
/// length. A line is known across itself only.
struct LineFeatures {
  std::size_t direction = 0, length = 0;
};

/// Returns the features of lines; `std::nullopt` for a type that lacks a direction named `direction` or a
/// `length` among its compared features.
std::optional<LineFeatures> line_features(const LandmarkType& type);

/// Quality of a landmark that was observed but not assessed, the mean of a quality that may be anything. With
/// 1, which eq. 7 gives to a single observation, it would outrank every landmark that images agree on.
inline constexpr double kUnassessedQuality = 0.5;

/// Converts all landmarks of a map. `sensor`: profile for eq. 8; null: equal weights.
std::vector<MapLandmark> to_map_landmarks(const SemanticMap& map, const SensorProfile* sensor = nullptr);

/// Converts one landmark.
MapLandmark map_landmark(const Landmark& landmark, const LandmarkType& type, const LocalFrame& frame,
                         const SensorProfile* sensor = nullptr);

}  // namespace waymark::localization
