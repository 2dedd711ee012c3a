// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>
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
/// look before, since a robot that stands sees one thing many times. `name` begins their names. Without
/// `detect`, laser scans are left out.
std::vector<DriveLook> looks_of_drive(const localization::RobotLog& log,
                                      std::span<const localization::StampedPose> poses,
                                      const localization::ScanDetector& detect, const std::string& name,
                                      const DriveMappingOptions& options = {});

/// Returns whether a look would show a landmark at a position of the map, m, by range, angle of view and the
/// beam towards it. `direction`: azimuth of the open side, rad; NaN: seen from all sides.
bool covers(const DriveLook& look, const Eigen::Vector2d& at, double direction, double max_range);

/// Returns whether all beams towards an upright object of a radius, m, end behind it, as far to its sides as
/// the poses may err. False where the object could stand between two beams, and for scanners that tilt.
bool sees_through(const DriveLook& look, const Eigen::Vector2d& at, double radius,
                  const DriveMappingOptions& options = {});

}  // namespace waymark::workflows
