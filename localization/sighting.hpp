// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/identification/known_features.hpp"
#include "localization/identification/map_landmark.hpp"
#include "localization/pose2.hpp"
namespace waymark {

/// Type of a sighting of something of which the map has no type.
inline constexpr TypeId kNoSuchType = 0xFFFF;

/// A landmark seen by the robot: d in D of eq. 9. Bearings are radians from the sensor's x axis (forward) to
/// the left; ranges are metres on the ground to the middle of the landmark, absent for a camera that measures
/// directions only. Features lie in the order of the type.
struct SeenLandmark {
  std::optional<TypeId> type;  ///< absent: could be of any type; features are not compared then
  double bearing = 0, bearing_sd = 0.02;
  std::optional<double> range;
  double range_sd = 0.1;  ///< m; of no meaning without a range
  /// rad above the horizontal, of a summit on the horizon; absent where only directions are measured.
  std::optional<double> elevation = {};
  double elevation_sd = 0.002;
  KnownFeatures features;
  std::optional<LandmarkKey> identity;  ///< where the landmark says who it is
  double confidence = 1;                ///< probability that it is one, (0, 1]

  /// Whether every number can be used: finite, range > 0, standard deviations > 0.
  bool sound() const;
};

/// What a sensor saw at one time. Sightings of one set belong to different landmarks.
struct SightingSet {
  Pose2 robot_from_sensor;
  std::vector<SeenLandmark> sightings;
};

inline bool SeenLandmark::sound() const {
  if (elevation && !(std::abs(*elevation) < 1.6 && elevation_sd > 0)) return false;
  return std::isfinite(bearing) && std::isfinite(bearing_sd) && bearing_sd > 0 && confidence > 0 &&
         confidence <= 1 &&
         (!range || (std::isfinite(*range) && *range > 0 && std::isfinite(range_sd) && range_sd > 0));
}

}  // namespace waymark
