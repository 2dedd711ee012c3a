// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/identification/known_features.hpp"
#include "localization/identification/map_landmark.hpp"
#include "localization/pose2.hpp"
namespace waymark::localization {

/// Type of a sighting whose landmark type is not in the map.
inline constexpr TypeId kNoSuchType = 0xFFFF;

/// A sighting of one landmark: d in D of eq. 9. Bearings are radians from the sensor's x axis (forward) to
/// the left. Ranges are metres on the ground to the landmark's centre, absent for a camera that measures
/// directions only. Features are in the order of the type.
struct SeenLandmark {
  std::optional<TypeId> type;  ///< absent: any type; features are not compared then
  double bearing = 0, bearing_sd = 0.02;
  std::optional<double> range;
  double range_sd = 0.1;  ///< m; ignored without a range
  /// rad above the horizontal, of a summit on the horizon; absent otherwise.
  std::optional<double> elevation = {};
  double elevation_sd = 0.002;
  KnownFeatures features;
  std::optional<LandmarkKey> identity;  ///< of a landmark that identifies itself, e.g. a bar code
  double confidence = 1;                ///< probability that it is a landmark, (0, 1]

  /// Returns whether every number can be used: finite, range > 0, standard deviations > 0.
  bool is_valid() const;
};

/// Sightings of one sensor at one time. They belong to different landmarks.
struct SightingSet {
  Pose2 robot_from_sensor;
  std::vector<SeenLandmark> sightings;
};

inline bool SeenLandmark::is_valid() const {
  if (elevation && !(std::abs(*elevation) < 1.6 && elevation_sd > 0)) return false;
  return std::isfinite(bearing) && std::isfinite(bearing_sd) && bearing_sd > 0 && confidence > 0 &&
         confidence <= 1 &&
         (!range || (std::isfinite(*range) && *range > 0 && std::isfinite(range_sd) && range_sd > 0));
}

}  // namespace waymark::localization
