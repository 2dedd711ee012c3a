// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark::workflows {

/// What of a log is mirrored at the robot's forward axis.
enum class MirroredPart {
  sensors,  ///< bearings and beams
  robot,    ///< these, and motion and mounts: the y axis of the robot points to the right
  motion,   ///< motion alone, e.g. turns counted clockwise
};

/// Returns the log with left and right exchanged. Panoramas are left out.
localization::RobotLog mirror_log(const localization::RobotLog& log, MirroredPart part);

/// Returns the log up to its 200th scan or set of sightings.
localization::RobotLog beginning_of(const localization::RobotLog& log);

/// Returns whether a drive fits its map so badly that its log is worth a second look: of 20 sightings or more
/// less than half are matched, or a tenth of the rows is lost.
bool fits_badly(const localization::Track& track);

/// Returns a warning if the best track of a mirrored log fits much better: a quarter of its sightings is
/// matched, at least twice as many as `as_written`, and no more rows are lost. Empty otherwise. The mean NIS
/// decides whether the motion is mirrored with the sensors, if it differs by a tenth.
std::string mirror_warning(const localization::Track& as_written, const localization::Track& with_sensors,
                           const localization::Track& with_robot, const localization::Track& with_motion);

}  // namespace waymark::workflows
