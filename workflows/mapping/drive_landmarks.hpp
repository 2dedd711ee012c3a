// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "geo/local_frame.hpp"
#include "landmarks/landmark_type.hpp"
#include "localization/replay_log.hpp"
namespace waymark::workflows {

/// Options of landmarks from a drive with known poses.
struct DriveMappingOptions {
  double min_step = 0.25, min_turn = 0.2;    ///< m, rad between two looks that are used
  double position_sd = 0.03, yaw_sd = 0.01;  ///< m, rad: of the given poses
  double max_gap = 0.5;                      ///< s between two poses that may be interpolated
  double max_range = 20;                     ///< m: farther sightings are not used
  double association_sd = 0.05;              ///< m: of positions from looks that share an error
  double max_distance = 0.5;                 ///< m between observations of one landmark
};

/// What the sensor saw from one known pose.
struct DriveLook {
  std::string name;                     ///< unique, source of its observations
  localization::Pose2 map_from_sensor;  ///< map frame, m
  localization::SightingSet seen;
  localization::LaserScan scan;  ///< without ranges if the log has sightings only
};

/// Returns the looks of a drive at known poses: the first, and each that is `min_step` or `min_turn` from the
/// look before, since a robot that stands sees one thing many times. `name` begins their names.
std::vector<DriveLook> looks_of_drive(const localization::RobotLog& log,
                                      std::span<const localization::StampedPose> poses,
                                      const localization::ScanDetector& detect, const std::string& name,
                                      const DriveMappingOptions& options = {});

/// Landmarks of a drive, with quality, and their evidence.
struct DriveLandmarks {
  std::vector<Landmark> landmarks;
  std::vector<Observation> evidence;
  std::int64_t improbable = 0;  ///< landmarks removed as too improbable
  std::int64_t too_far = 0;     ///< sightings beyond `max_range`
  std::int64_t unplaced = 0;    ///< sightings with a bearing or a range alone
  std::int64_t untyped = 0;     ///< sightings without a type, or whose type is open
};

/// Merges the sightings of looks into landmarks and values them (Rossmann et al. 3.2 and 3.3, a look in place
/// of an image). They are in the CRS of `frame`, that of the looks; heights are unknown.
/// - A look covers a landmark if it detected it. So does one no farther than the farthest look that did (eq.
///   4), if the beam towards the landmark reaches it from the open side.
/// - Looks through the place of an upright object count strongly against it: people and cars move on.
DriveLandmarks landmarks_of_looks(std::span<const DriveLook> looks, const TypeRegistry& types,
                                  const LocalFrame& frame, const DriveMappingOptions& options = {});

/// Returns whether a look would show a landmark at a position of the map, m, by range, angle of view and the
/// beam towards it. `direction`: azimuth of the open side, rad; NaN: seen from all sides.
bool covers(const DriveLook& look, const Eigen::Vector2d& at, double direction, double max_range);

/// Returns whether all beams towards an upright object of a radius, m, end behind it, as far to its sides as
/// the poses may err. False where the object could stand between two beams, and for scanners that tilt.
bool sees_through(const DriveLook& look, const Eigen::Vector2d& at, double radius,
                  const DriveMappingOptions& options = {});

}  // namespace waymark::workflows
