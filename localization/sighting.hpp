// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>
#include "localization/identification/known_features.hpp"
#include "localization/identification/map_landmark.hpp"
#include "localization/pose2.hpp"
namespace waymark::localization {

/// Type of a sighting whose landmark type is not in the map.
inline constexpr TypeId kNoSuchType = 0xFFFF;

/// A sighting of one landmark: d in D of eq. 9. Bearings are radians from the sensor's x axis (forward) to
/// the left. Ranges are metres on the ground to the landmark's centre; cameras measure bearings alone,
/// radios ranges alone. Features are in the order of the type.
struct SeenLandmark {
  std::optional<TypeId> type;  ///< absent: any type; features are not compared then
  std::optional<double> bearing = {};
  double bearing_sd = 0.02;  ///< rad; ignored without a bearing
  std::optional<double> range;
  double range_sd = 0.1;  ///< m; ignored without a range
  /// rad above the horizontal, of a summit on the horizon; absent otherwise. Needs a bearing.
  std::optional<double> elevation = {};
  double elevation_sd = 0.002;
  KnownFeatures features;
  std::optional<LandmarkKey> identity;  ///< of a landmark that identifies itself, e.g. a bar code
  double confidence = 1;                ///< probability that it is a landmark, (0, 1]

  /// Returns whether range and bearing are measured, which give a position relative to the sensor.
  bool has_position() const { return range && bearing; }
  /// Returns whether every number can be used: finite, range > 0, standard deviations > 0. At least one of
  /// range and bearing is needed.
  bool is_valid() const;
};

/// A range to an identified landmark, measured before at another place.
struct EarlierRange {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< place of the sensor, in the present frame of the robot
  /// Covariance of the motion since: displacement and turn about the present position. For two ranges, that
  /// of the later one is common to both.
  Eigen::Matrix3d motion = Eigen::Matrix3d::Zero();
  double range = 0, sd = 0.1;  ///< m
  LandmarkKey landmark = 0;
};

/// Sightings of one sensor at one time. They belong to different landmarks.
struct SightingSet {
  Pose2 robot_from_sensor;
  std::vector<SeenLandmark> sightings;
  std::vector<EarlierRange> earlier_ranges = {};  ///< for a PoseFinder only; the oldest first
};

inline bool SeenLandmark::is_valid() const {
  if (!bearing && !range) return false;
  if (elevation && !(bearing && std::abs(*elevation) < 1.6 && elevation_sd > 0)) return false;
  return confidence > 0 && confidence <= 1 &&
         (!bearing || (std::isfinite(*bearing) && std::isfinite(bearing_sd) && bearing_sd > 0)) &&
         (!range || (std::isfinite(*range) && *range > 0 && std::isfinite(range_sd) && range_sd > 0));
}

}  // namespace waymark::localization
