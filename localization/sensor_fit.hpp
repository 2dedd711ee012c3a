// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <vector>
#include "landmarks/sensor_profile.hpp"
#include "localization/identification/landmark_grid.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// A set of sightings and the true pose of the robot at its time.
struct SightingsAtTruth {
  Pose2 robot;
  SightingSet seen;
};

/// Coverage of a sensor as drives with true poses show it.
struct SensorFit {
  SensorCoverage coverage;
  std::size_t matched = 0;   ///< sightings within `max_error` of a landmark
  std::size_t expected = 0;  ///< times a landmark was in range and view
};

/// Estimates range, field of view, noise and detection probability of a sensor.
/// - A sighting is of the nearest landmark of its type within `max_error` metres (of a bearing: that divided
///   by the landmark's range); a landmark has one sighting at most.
/// - Range and view enclose 99 % of the matched sightings. Standard deviations are those within three of
///   them, less the mean variance of the map.
/// - Detection: logistic regression on range and log diameter, where diameters are known (iterated least
///   squares). Landmarks that terrain hides count as missed.
/// Throws Error{input} for fewer than 30 matched sightings.
SensorFit fit_sensor(std::span<const SightingsAtTruth> sets, const LandmarkGrid& map, double max_error = 1);

}  // namespace waymark::localization
