// SPDX-License-Identifier: Apache-2.0
#include "localization/replay_log.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "localization/identification/joint_evidence.hpp"

namespace waymark::localization {
namespace {

OdometryDrift drift_of(const RobotLog& log, const ReplayOptions& options) {
  return options.drift == OdometryDrift{} ? log.drift : options.drift;
}

}  // namespace

LogReplay::LogReplay(const RobotLog& log, Localizer& localizer, const ReplayOptions& options,
                     ScanDetector detect, TimeSource clock, TerrainHeight ground)
    : localizer_(localizer),
      options_(options),
      car_(log.car),
      odometry_(log.odometry && options.odometry == OdometryNoise{} ? *log.odometry : options.odometry),
      errors_(drift_of(log, options), options.frames),
      detect_(std::move(detect)),
      clock_(std::move(clock)),
      ground_(std::move(ground)),
      repeated_(
          {options.error_memory * log.error_memory.range, options.error_memory * log.error_memory.bearing}) {}

bool LogReplay::take(const LogEvent& event) {
  if (!first_) first_ = now_ = last_step_ = event.t;
  advance(event.t);
  TrackRow row;
  const bool seen = std::visit([&](const auto& reading) { return take(reading, row); }, event.what);
  if (!seen && !options_.every_event) return false;
  row.t = event.t;
  row.at = errors_.robot(localizer_.estimate());
  track_.mount = errors_.mount();
  row.lost = localizer_.status() != LocalizationStatus::tracking;
  update_terrain_pose(row.at.pose);
  row.z = terrain_pose_.z, row.roll = terrain_pose_.roll, row.pitch = terrain_pose_.pitch;
  if (!row.at.pose.finite() || !row.at.covariance.allFinite())
    throw std::logic_error("the estimate of the localizer is not finite");
  track_.rows.push_back(row);
  return true;
}

void LogReplay::forget_rows() {
  if (track_.rows.size() > 1) track_.rows.erase(track_.rows.begin(), track_.rows.end() - 1);
}

// Applies the speeds of the last reading until `t`, but no longer than max_hold. Then the robot
// stands, and only the uncertainty of time grows.
void LogReplay::advance(double t) {
  const double seconds = std::max(0.0, t - now_), driven = std::min(seconds, options_.max_hold);
  now_ = std::max(now_, t);
  if (const auto* twist = std::get_if<TwistReading>(&current_reading_))
    drive(twist_motion(twist->speed, twist->sideways, twist->turn, driven, odometry_), driven);
  else if (const auto* car = std::get_if<CarReading>(&current_reading_))
    drive(ackermann_motion(car_, car->wheel_speed, car->steering, driven, odometry_), driven);
  if (seconds > driven) predict(step_motion({}, seconds - driven, odometry_));
}

void LogReplay::drive(BodyMotion motion, double seconds) {
  motion.step = project_to_map(motion.step, terrain_pose_);
  if (errors_.any()) motion = errors_.correct(localizer_.assumed_estimate(), motion, seconds);
  predict(motion);
}

void LogReplay::predict(const BodyMotion& motion) {
  localizer_.predict(motion);
  repeated_.predict(motion);
  dead_reckoning_ = dead_reckoning_ * motion.step;
}

void LogReplay::update_terrain_pose(const Pose2& pose) {
  if (!ground_) return;
  const auto terrain_pose = pose_on_terrain(ground_, pose, {options_.wheelbase, options_.track_width});
  terrain_pose_ = terrain_pose ? *terrain_pose : TerrainPose{pose, terrain_pose_.z, 0, 0};
}

bool LogReplay::take(const TwistReading& reading, TrackRow&) {
  return current_reading_ = reading, false;
}
bool LogReplay::take(const CarReading& reading, TrackRow&) {
  return current_reading_ = reading, false;
}
bool LogReplay::take(const StepReading& reading, TrackRow&) {
  const double seconds = std::max(0.0, now_ - last_step_);
  drive(step_motion(reading.step, seconds, odometry_), seconds);
  last_step_ = now_;
  return false;
}

template <class Fix>
bool LogReplay::take_fix(const Fix& fix, TrackRow&) {
  if (!options_.use_fixes) return false;
  ++track_.fixes;
  const PoseEstimate prior = localizer_.assumed_estimate();
  const bool used = localizer_.fix(errors_.relative_to_map(fix, prior));
  track_.fixes_rejected += !used;
  if (!errors_.any()) return false;
  if (localizer_.status() != LocalizationStatus::tracking)
    errors_.consider(prior, localizer_.assumed_estimate());
  else if (used)
    errors_.learn(fix, prior, localizer_.assumed_estimate());
  return false;
}

void LogReplay::learn_errors(const PoseEstimate& prior) {
  if (!errors_.any()) return;
  if (localizer_.status() == LocalizationStatus::tracking)
    errors_.learn(prior, localizer_.assumed_estimate());
  else
    errors_.consider(prior, localizer_.assumed_estimate());
}

void LogReplay::learn_shift(const SightingSet& seen, const PoseEstimate& prior) {
  if (!options_.frames.shift_is_learnt() || localizer_.status() != LocalizationStatus::tracking) return;
  independent_.learn(seen, matches_, prior);
  errors_.scale_shift(options_.frames.survey_sd * std::sqrt(1 - independent_.mean()));
}

bool LogReplay::take(SightingSet seen, TrackRow& row) {
  for (SeenLandmark& s : seen.sightings) {
    s.bearing_sd *= options_.sensor_noise;
    s.range_sd *= options_.sensor_noise;
  }
  repeated_.widen(seen, now_);
  const PoseEstimate prior = localizer_.assumed_estimate();
  const double before = clock_ ? clock_() : 0;
  matches_ = localizer_.update(seen);
  if (clock_) track_.seconds += row.seconds = clock_() - before;
  learn_errors(prior);
  learn_shift(seen, prior);
  ++track_.updates;
  JointEvidence evidence;
  for (std::size_t i = 0; i < matches_.size(); ++i) {
    ++track_.verdicts[static_cast<std::size_t>(matches_[i].verdict)];
    if (matches_[i].verdict != Verdict::matched) {
      ++row.rejected;
      continue;
    }
    ++row.matched;
    evidence += matches_[i].pairing.evidence;
    if (!seen.sightings[i].identity) continue;
    ++track_.named;
    row.wrong += *seen.sightings[i].identity != matches_[i].key;
  }
  track_.wrong += row.wrong;
  if (evidence.rows)
    row.nis = joint_distance(evidence, prior.covariance).squares, row.nis_rows = evidence.rows;
  seen_ = std::move(seen);
  return true;
}

void ReplayOptions::describe(OptionVisitor& option) {
  odometry.describe(option);
  drift.describe(option);
  frames.describe(option);
  option("max_hold", max_hold,
         {.help = "Seconds a speed holds without a new reading; then the robot stands",
          .min = 0,
          .formerly = "longest_hold"});
  option("use_fixes", use_fixes, {.help = "Use the GNSS and compass readings of the log"});
  option("wheelbase", wheelbase,
         {.help = "Metres between front and rear wheels on the DEM", .min = 0.01, .max = 100});
  option("track_width", track_width,
         {.help = "Metres between left and right wheels on the DEM", .min = 0.01, .max = 100});
  option("sensor_noise", sensor_noise,
         {.help = "Factor on the standard deviations of ranges and bearings in the log",
          .min = 0.01,
          .max = 100});
  option("error_memory", error_memory,
         {.help = "Factor on the correlation times of sensor errors in the log; 0: independent errors",
          .min = 0,
          .max = 1000});
}

Track replay(const RobotLog& log, Localizer& localizer, const ReplayOptions& options,
             const ScanDetector& detect, const TimeSource& clock, const TerrainHeight& ground,
             const TrackWatcher& watch) {
  LogReplay replay(log, localizer, options, detect, clock, ground);
  for (const LogEvent& event : log.events)
    if (replay.take(event) && watch) watch(replay.track());
  return replay.track();
}

}  // namespace waymark::localization
