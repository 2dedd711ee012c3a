// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include "localization/robot_log.hpp"
#include "localization/terrain_pose.hpp"
#include "localization/track.hpp"
namespace waymark::localization {

/// Options of the replay of a log.
struct ReplayOptions {
  OdometryNoise odometry;                 ///< unchanged: that of the log's reader, if it gives one
  double max_hold = 1;                    ///< s: how long a speed holds without a new reading
  double sensor_noise = 1;                ///< factor on the standard deviations the log states
  double error_memory = 1;                ///< factor on the correlation times of the log's sensor errors
  bool use_fixes = true;                  ///< use GNSS and compass readings
  double wheelbase = 1, track_width = 1;  ///< m between the wheels, for roll and pitch on the terrain
  bool every_event = true;                ///< a row for each event; false: for each set of sightings

  void describe(OptionVisitor& option);
};

/// Converts a scan to sightings. Empty: scans are ignored.
using ScanDetector = std::function<SightingSet(const LaserScan&)>;
/// Returns seconds since a fixed moment, to time updates. Empty: updates are not timed.
using TimeSource = std::function<double()>;

/// Receives the track so far after each new row.
using TrackWatcher = std::function<void(const Track&)>;

/// Replays a log to a localizer, from the first event to the last. Every row is finite. With `ground`,
/// distances driven on a slope are projected to the map, and rows have z, roll and pitch. Where the terrain
/// is unknown, rows have the last known height and zero angles.
Track replay(const RobotLog& log, Localizer& localizer, const ReplayOptions& options,
             const ScanDetector& detect = {}, const TimeSource& clock = {}, const TerrainHeight& ground = {},
             const TrackWatcher& watch = {});

}  // namespace waymark::localization
