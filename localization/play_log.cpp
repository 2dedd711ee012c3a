// SPDX-License-Identifier: Apache-2.0
#include "localization/play_log.hpp"

#include <algorithm>
#include <stdexcept>

#include "localization/identification/joint_evidence.hpp"

namespace waymark {
namespace {

class Player {
 public:
  Player(const RobotLog& log, Localizer& localizer, const PlayOptions& options, const ScanDetector& detect,
         const Clock& clock, const GroundHeight& ground)
      : log_(log),
        localizer_(localizer),
        options_(options),
        odometry_(log.odometry && options.odometry == OdometryNoise{} ? *log.odometry : options.odometry),
        detect_(detect),
        clock_(clock),
        ground_(ground),
        repeated_({options.error_memory * log.error_memory.range,
                   options.error_memory * log.error_memory.bearing}) {}

  Track play(const TrackWatcher& watch) {
    if (!log_.events.empty()) now_ = log_.events.front().t;
    for (const LogEvent& event : log_.events) {
      advance(event.t);
      TrackRow row;
      const bool seen = std::visit([&](const auto& reading) { return take(reading, row); }, event.what);
      if (!seen && !options_.every_event) continue;
      row.t = event.t;
      row.at = localizer_.estimate();
      row.lost = localizer_.trust() != Trust::sure;
      look_down(row.at.pose);
      row.z = stance_.z, row.roll = stance_.roll, row.pitch = stance_.pitch;
      if (!row.at.pose.finite() || !row.at.covariance.allFinite())
        throw std::logic_error("a localizer has an estimate that is not finite");
      track_.rows.push_back(row);
      if (watch) watch(track_);
    }
    return std::move(track_);
  }

 private:
  // The speeds of the last reading hold until `t`, but no longer than longest_hold; then the robot stands,
  // and only the uncertainty of time grows.
  void advance(double t) {
    const double seconds = std::max(0.0, t - now_), driven = std::min(seconds, options_.longest_hold);
    now_ = std::max(now_, t);
    if (const auto* twist = std::get_if<TwistReading>(&held_))
      drive(twist_motion(twist->speed, twist->sideways, twist->turn, driven, odometry_));
    else if (const auto* car = std::get_if<CarReading>(&held_))
      drive(ackermann_motion(log_.car, car->wheel_speed, car->steering, driven, odometry_));
    if (seconds > driven) move(step_motion({}, seconds - driven, odometry_));
  }

  void drive(BodyMotion motion) {
    motion.step = on_map(motion.step, stance_);
    move(motion);
  }

  void move(const BodyMotion& motion) {
    localizer_.move(motion);
    repeated_.move(motion);
  }

  void look_down(const Pose2& pose) {
    if (!ground_) return;
    const auto stance = stand(ground_, pose, options_.wheelbase, options_.track_width);
    stance_ = stance ? *stance : Stance{stance_.z, 0, 0};
  }

  bool take(const TwistReading& reading, TrackRow&) { return held_ = reading, false; }
  bool take(const CarReading& reading, TrackRow&) { return held_ = reading, false; }
  bool take(const StepReading& reading, TrackRow&) {
    drive(step_motion(reading.step, std::max(0.0, now_ - last_step_), odometry_));
    last_step_ = now_;
    return false;
  }
  bool take(const GnssFix& fix, TrackRow&) { return take_fix(fix); }
  bool take(const HeadingFix& fix, TrackRow&) { return take_fix(fix); }
  bool take(const LaserScan& scan, TrackRow& row) { return detect_ && take(detect_(scan), row); }

  template <class Fix>
  bool take_fix(const Fix& fix) {
    if (!options_.use_fixes) return false;
    ++track_.fixes;
    track_.fixes_rejected += !localizer_.fix(fix);
    return false;
  }

  bool take(SightingSet seen, TrackRow& row) {
    for (SeenLandmark& s : seen.sightings) {
      s.bearing_sd *= options_.sensor_noise;
      s.range_sd *= options_.sensor_noise;
    }
    repeated_.widen(seen, now_);
    const Eigen::Matrix3d prior = localizer_.estimate().covariance;
    const double before = clock_ ? clock_() : 0;
    const std::vector<Match> matches = localizer_.see(seen);
    if (clock_) track_.seconds += row.seconds = clock_() - before;
    ++track_.updates;
    JointEvidence evidence;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      ++track_.verdicts[static_cast<std::size_t>(matches[i].verdict)];
      if (matches[i].verdict != Verdict::matched) {
        ++row.rejected;
        continue;
      }
      ++row.matched;
      evidence += matches[i].pairing.evidence;
      if (!seen.sightings[i].identity) continue;
      ++track_.named;
      row.wrong += *seen.sightings[i].identity != matches[i].key;
    }
    track_.wrong += row.wrong;
    if (evidence.rows) row.nis = joint_distance(evidence, prior).squares, row.nis_rows = evidence.rows;
    return true;
  }

  const RobotLog& log_;
  Localizer& localizer_;
  const PlayOptions& options_;
  const OdometryNoise odometry_;
  const ScanDetector& detect_;
  const Clock& clock_;
  const GroundHeight& ground_;
  Stance stance_;
  RepeatedSightings repeated_;
  Track track_;
  std::variant<std::monostate, TwistReading, CarReading> held_;
  double now_ = 0, last_step_ = 0;
};

}  // namespace

void PlayOptions::describe(OptionVisitor& option) {
  odometry.describe(option);
  option("longest_hold", longest_hold,
         {.help = "Seconds a speed holds without a new reading; then the robot is taken to stand", .min = 0});
  option("use_fixes", use_fixes, {.help = "Use the GNSS and compass readings of the log"});
  option("wheelbase", wheelbase,
         {.help = "Metres between front and rear wheels on the DEM", .min = 0.01, .max = 100});
  option("track_width", track_width,
         {.help = "Metres between left and right wheels on the DEM", .min = 0.01, .max = 100});
  option("sensor_noise", sensor_noise,
         {.help = "Factor on the standard deviations of ranges and bearings that the log states",
          .min = 0.01,
          .max = 100});
  option(
      "error_memory", error_memory,
      {.help = "Factor on the times over which the log says a sensor's errors stay alike; 0: each sighting "
               "errs anew",
       .min = 0,
       .max = 1000});
}

Track play(const RobotLog& log, Localizer& localizer, const PlayOptions& options, const ScanDetector& detect,
           const Clock& clock, const GroundHeight& ground, const TrackWatcher& watch) {
  return Player(log, localizer, options, detect, clock, ground).play(watch);
}

}  // namespace waymark
