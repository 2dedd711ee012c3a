// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include "localization/independent_fraction.hpp"
#include "localization/persistent_errors.hpp"
#include "localization/robot_log.hpp"
#include "localization/terrain_pose.hpp"
#include "localization/track.hpp"
namespace waymark::localization {

/// Options of the replay of a log.
struct ReplayOptions {
  OdometryNoise odometry;                 ///< unchanged: that of the log, if it states one
  OdometryDrift drift;                    ///< unchanged: that of the log
  FrameErrors frames;                     ///< of map and sensors
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

/// Gives readings to a localizer one by one, in the order of time, as replay() does. The localizer must
/// outlive it.
class LogReplay {
 public:
  /// Of the log only the car, the memory of errors, the odometry noise and its drift are used. Rows have the
  /// robot's pose in the reference frame (FrameErrors); that of the localizer is relative to landmarks.
  LogReplay(const RobotLog& log, Localizer& localizer, const ReplayOptions& options, ScanDetector detect = {},
            TimeSource clock = {}, TerrainHeight ground = {});

  /// Takes the next event. Returns false if it makes no row of the track.
  bool take(const LogEvent& event);

  const Track& track() const { return track_; }
  /// Removes all rows of the track but the last, of a robot that drives for days. Counts stay.
  void forget_rows();
  /// Returns the sightings that were taken last, and a match for each.
  const SightingSet& seen() const { return seen_; }
  const std::vector<Match>& matches() const { return matches_; }
  /// Returns the motion by odometry alone since the first event.
  const Pose2& dead_reckoning() const { return dead_reckoning_; }

 private:
  void advance(double t);
  void drive(BodyMotion motion, double seconds);
  void predict(const BodyMotion& motion);
  void learn_errors(const PoseEstimate& prior);
  void learn_shift(const SightingSet& seen, const PoseEstimate& prior);
  void update_terrain_pose(const Pose2& pose);
  bool take(const TwistReading& reading, TrackRow& row);
  bool take(const CarReading& reading, TrackRow& row);
  bool take(const StepReading& reading, TrackRow& row);
  bool take(const GnssFix& fix, TrackRow& row) { return take_fix(fix, row); }
  bool take(const HeadingFix& fix, TrackRow& row) { return take_fix(fix, row); }
  bool take(const LaserScan& scan, TrackRow& row) { return detect_ && take(detect_(scan), row); }
  bool take(SightingSet seen, TrackRow& row);
  template <class Fix>
  bool take_fix(const Fix& fix, TrackRow& row);

  Localizer& localizer_;
  ReplayOptions options_;
  Ackermann car_;
  OdometryNoise odometry_;
  PersistentErrors errors_;
  IndependentFraction independent_;  // of the accuracy that the map states
  ScanDetector detect_;
  TimeSource clock_;
  TerrainHeight ground_;
  TerrainPose terrain_pose_;
  RepeatedSightings repeated_;
  Track track_;
  SightingSet seen_;
  std::vector<Match> matches_;
  Pose2 dead_reckoning_;
  std::variant<std::monostate, TwistReading, CarReading> current_reading_;
  std::optional<double> first_;
  double now_ = 0, last_step_ = 0;
};

/// Replays a log to a localizer, from the first event to the last. Every row is finite. With `ground`,
/// distances driven on a slope are projected to the map, and rows have z, roll and pitch. Where the terrain
/// is unknown, rows have the last known height and zero angles.
Track replay(const RobotLog& log, Localizer& localizer, const ReplayOptions& options,
             const ScanDetector& detect = {}, const TimeSource& clock = {}, const TerrainHeight& ground = {},
             const TrackWatcher& watch = {});

}  // namespace waymark::localization
