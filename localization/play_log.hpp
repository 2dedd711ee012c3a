// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include "localization/ground.hpp"
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark {

struct PlayOptions {
  OdometryNoise odometry;                 ///< unchanged: as the reader of the log knows it, if it does
  double longest_hold = 1;                ///< s: how long a speed holds without a new reading
  double sensor_noise = 1;                ///< factor on the standard deviations the log states
  double error_memory = 1;                ///< factor on the times over which the log says errors stay alike
  bool use_fixes = true;                  ///< GNSS and compass readings are used
  double wheelbase = 1, track_width = 1;  ///< m, between the wheels: what of the ground tilts the robot
  bool every_event = true;                ///< a row for each event; false: for each set of sightings

  void describe(OptionVisitor& option);
};

/// Turns a scan into sightings; none given: scans are left out.
using ScanDetector = std::function<SightingSet(const LaserScan&)>;
/// Seconds since some moment, to measure updates; none given: not measured.
using Clock = std::function<double()>;

/// Is shown the track so far after each new row.
using TrackWatcher = std::function<void(const Track&)>;

/// Plays a log to a localizer, from the first event to the last. Every row is finite. With the ground known,
/// way driven on a slope is shortened to what it is on the map, and rows have z, roll and pitch; where the
/// ground is not known, those of level ground at the last known height.
Track play(const RobotLog& log, Localizer& localizer, const PlayOptions& options,
           const ScanDetector& detect = {}, const Clock& clock = {}, const GroundHeight& ground = {},
           const TrackWatcher& watch = {});

}  // namespace waymark
