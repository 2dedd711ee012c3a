// SPDX-License-Identifier: Apache-2.0
#include "robot_session.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace waymark::ros {
namespace {

Stamp nanoseconds(double seconds) {
  return static_cast<Stamp>(std::llround(seconds * 1e9));
}

/// Returns the pose; `std::nullopt` if it is not finite or its quaternion is not of length 1.
std::optional<Eigen::Isometry3d> checked(const Pose& pose) {
  if (!(pose.at.allFinite() && std::abs(pose.turn.norm() - 1) < 0.1)) return {};
  return Eigen::Translation3d(pose.at) * pose.turn.normalized();
}

/// Parses "X,Y,YAW".
localization::Pose2 parse_start(const std::string& text) {
  std::array<double, 3> v{};
  const char *from = text.data(), *end = text.data() + text.size();
  bool sound = true;
  for (std::size_t i = 0; i < v.size() && sound; ++i) {
    const auto [rest, fault] = std::from_chars(from, end, v[i]);
    sound = fault == std::errc() && (i + 1 == v.size() ? rest == end : rest != end && *rest == ',');
    from = sound && rest != end ? rest + 1 : end;
  }
  const localization::Pose2 pose{v[0], v[1], v[2]};
  if (!sound || !pose.finite() || std::abs(pose.yaw) > 12.6)
    throw Error(ErrorCode::usage, "the parameter start is neither X,Y,YAW nor none, but '" + text + "'", "",
                "e.g. 12.5,-3,1.57: metres in the map frame, and radians");
  return {pose.x, pose.y, localization::wrap_angle(pose.yaw)};
}

Covariance6 in_space(const Eigen::Matrix3d& covariance) {
  constexpr std::array<int, 3> kRows{0, 1, 5};  // x, y, turn about z
  Covariance6 all{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      all[static_cast<std::size_t>(6 * kRows[static_cast<std::size_t>(i)] +
                                   kRows[static_cast<std::size_t>(j)])] = covariance(i, j);
  return all;
}

/// Returns the covariance of x, y and yaw; `std::nullopt` if it is none.
std::optional<Eigen::Matrix3d> in_plane(const Covariance6& all) {
  Eigen::Matrix3d c;
  c << all[0], all[1], all[5], all[6], all[7], all[11], all[30], all[31], all[35];
  c = (c + c.transpose()).eval() / 2;
  const bool sound =
      c.allFinite() && c(0, 0) > 0 && c.topLeftCorner<2, 2>().determinant() > 0 && c.determinant() > 0;
  return sound ? std::optional(c) : std::nullopt;
}

Eigen::Quaterniond turn_of(double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
         AngleAxisd(roll, Vector3d::UnitX());
}

localization::RobotLog robot_of(const SessionSettings& settings) {
  localization::RobotLog robot;
  if (settings.odometry != OdometryUse::pose_with_gyro || !(settings.gyro_noise > 0)) return robot;
  importers::use_gyro_noise(robot, settings.gyro_noise);
  return robot;
}

}  // namespace

double seconds_of(Stamp stamp) {
  constexpr Stamp kSecond = 1'000'000'000;
  Stamp whole = stamp / kSecond, rest = stamp % kSecond;
  if (rest < 0) --whole, rest += kSecond;
  return static_cast<double>(whole) + static_cast<double>(rest) / 1e9;
}

RobotSession::RobotSession(SessionSettings settings) : settings_(std::move(settings)) {
  if (!(settings_.max_delay >= 0 && settings_.max_gap > 0 && settings_.max_jump_back > settings_.max_delay))
    throw Error(ErrorCode::usage, "max_delay must not be negative, max_gap and max_jump_back be above it", "",
                "e.g. max_delay 0.1, max_gap 1, max_jump_back 1");
  const workflows::Callbacks callbacks{.progress = {},
                                       .message = [warnings = warnings_](const workflows::Message& message) {
                                         if (message.kind == workflows::MessageKind::warning)
                                           warnings->add(message.text);
                                       }};
  live_ = std::make_unique<workflows::LiveLocalizer>(settings_.request, robot_of(settings_), callbacks);
  begin_as_set();
}

void RobotSession::begin_as_set() {
  if (settings_.start == "none")
    begin({});
  else if (!settings_.start.empty())
    begin(live_->start_at(parse_start(settings_.start)));
  else if (initial_pose_)
    begin(initial_pose_);
}

void RobotSession::begin(const std::optional<localization::PoseEstimate>& start) {
  odom_ = odom_from_base();
  reckoned_ = {};
  live_->restart(start);
  last_report_.reset();
  sighting_markers_.clear();
}

localization::Pose2 RobotSession::odom_from_base() const {
  if (!live_->has_begun()) return odom_;
  return odom_ * (inverse(reckoned_) * live_->replay().dead_reckoning());
}

void RobotSession::drop(const std::string& reason) {
  if (++dropped_[reason] == 1) warnings_->add("a message is dropped: " + reason);
}

void RobotSession::Warnings::add(const std::string& text) {
  if (known.insert(text).second) fresh.push_back(text);
}

std::vector<std::string> RobotSession::take_warnings() {
  return std::exchange(warnings_->fresh, {});
}

void RobotSession::take(const StaticTransform& placed) {
  const auto parent_from_child = checked(placed.parent_from_child);
  if (!parent_from_child) return drop("the transform of " + placed.child + " is no pose");
  frames_.place(placed.child, placed.parent, *parent_from_child);
}

void RobotSession::take(const InitialPose& start) {
  const auto pose = checked(start.pose);
  if (!pose) return drop("an initial pose is no pose");
  if (start.frame != settings_.map_frame)
    return drop("an initial pose is in the frame '" + start.frame + "', not in " + settings_.map_frame);
  localization::PoseEstimate estimate = live_->start_at(importers::level_pose(*pose));
  if (const auto covariance = in_plane(start.covariance)) estimate.covariance = *covariance;
  initial_pose_ = estimate;
  begin(estimate);
}

std::optional<Eigen::Isometry3d> RobotSession::place_of(const std::string& frame) {
  if (frame == settings_.base_frame) return Eigen::Isometry3d::Identity();
  auto place = frames_.transform(settings_.base_frame, frame);
  if (!place) drop("no static transform leads from " + frame + " to " + settings_.base_frame);
  return place;
}

PoseReports RobotSession::take(const Odometry& message) {
  if (message.frame != settings_.odom_frame || message.body != settings_.base_frame)
    return drop("odometry is of " + message.body + " in " + message.frame + ", not of " +
                settings_.base_frame + " in " + settings_.odom_frame),
           PoseReports{};
  const auto pose = checked(message.pose);
  if (!pose) return drop("the pose of odometry is no pose"), PoseReports{};
  const Stepped step{.odom = {seconds_of(message.stamp), importers::level_pose(*pose)},
                     .z = pose->translation().z(),
                     .forward = message.forward,
                     .left = message.left,
                     .turn = message.turn};
  if (!std::isfinite(step.forward + step.left + step.turn) && settings_.odometry == OdometryUse::twist)
    return drop("the twist of odometry is not finite"), PoseReports{};
  return wait("odometry", message.stamp, step);
}

PoseReports RobotSession::take(const Scan& message) {
  const auto place = place_of(message.frame);
  if (!place) return {};
  if (!importers::is_level(*place))
    return drop("the scanner " + message.frame + " is tilted by more than 11 degrees"), PoseReports{};
  try {
    localization::LaserScan scan =
        importers::laser_scan(message.angle_min, message.angle_increment, message.range_min,
                              message.range_max, message.ranges, message.intensities);
    importers::mount(scan, *place);
    return wait("scan " + message.frame, message.stamp, std::move(scan));
  } catch (const std::runtime_error& problem) {
    return drop(problem.what()), PoseReports{};
  }
}

PoseReports RobotSession::take(const Fix& message) {
  if (message.status < 0) return drop("the receiver has no satellite fix"), PoseReports{};
  if (!(std::abs(message.latitude) <= 90 && std::abs(message.longitude) <= 360))
    return drop("a satellite fix is no latitude and longitude"), PoseReports{};
  const auto place = place_of(message.frame);
  if (!place) return {};
  try {
    const auto covariance = importers::horizontal_covariance(message.covariance, message.covariance_type);
    const double arm = place->translation().head<2>().norm();
    return wait("fix " + message.frame, message.stamp,
                importers::fix_of_antenna(message.longitude, message.latitude, covariance, arm));
  } catch (const std::runtime_error& problem) {
    return drop(problem.what()), PoseReports{};
  }
}

PoseReports RobotSession::take(const Imu& message) {
  const auto place = place_of(message.frame);
  if (!place) return {};
  const bool has_rate = message.rate_covariance[0] != -1,
             has_heading = message.orientation_covariance[0] != -1;
  const auto oriented = checked(Pose{.turn = message.orientation});
  if ((has_rate && !message.rate.allFinite()) || (has_heading && !oriented))
    return drop("an inertial reading is not finite, or its orientation is none"), PoseReports{};
  std::optional<Reading> heading;
  if (const double variance = message.orientation_covariance[8]; has_heading && variance > 0)
    heading = localization::HeadingFix{importers::level_pose(*oriented * place->inverse()).yaw,
                                       std::sqrt(variance)};
  PoseReports reports = wait("imu " + message.frame, message.stamp, std::move(heading));
  if (has_rate && settings_.odometry == OdometryUse::pose_with_gyro) {
    const importers::TurnRate rate{.t = seconds_of(message.stamp),
                                   .rate = (place->linear() * message.rate).z(),
                                   .variance = std::max(0.0, message.rate_covariance[8])};
    rates_.insert(std::ranges::upper_bound(rates_, rate.t, {}, &importers::TurnRate::t), rate);
  }
  return reports;
}

PoseReports RobotSession::wait(const std::string& sensor, Stamp stamp, std::optional<Reading> what) {
  PoseReports reports;
  const auto newest = newest_.find(sensor);
  if (newest != newest_.end() && stamp < newest->second - nanoseconds(settings_.max_jump_back)) {
    reports = flush();
    ++restarts_;
    warnings_->add("stamps of " + sensor +
                   " jump back, as when a recording is played again: the session begins again");
    newest_.clear(), rates_.clear();
    released_.reset(), last_odometry_.reset();
    odom_ = {};
    begin_as_set();
  }
  Stamp& own = newest_.try_emplace(sensor, stamp).first->second;
  own = std::max(own, stamp);
  if (released_ && stamp < *released_) {
    if (what) drop("stamps of " + sensor + " are too late behind those of other sensors");
  } else if (what) {
    const auto before = [](const Waiting& a, const Waiting& b) {
      return std::pair(a.stamp, a.what.index()) < std::pair(b.stamp, b.what.index());
    };
    Waiting waiting{stamp, std::move(*what)};
    waiting_.insert(std::ranges::upper_bound(waiting_, waiting, before), std::move(waiting));
  }
  Stamp latest = std::numeric_limits<Stamp>::min();
  for (const auto& [name, t] : newest_) latest = std::max(latest, t);
  const bool at_once = settings_.max_delay == 0;
  PoseReports more = release(latest - nanoseconds(settings_.max_delay) + (at_once ? 1 : 0));
  std::ranges::move(more, std::back_inserter(reports));
  return reports;
}

PoseReports RobotSession::release(std::optional<Stamp> before) {
  PoseReports reports;
  while (!waiting_.empty() && (!before || waiting_.front().stamp < *before)) {
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    released_ = std::max(released_.value_or(next.stamp), next.stamp);
    use(next, reports);
  }
  return reports;
}

PoseReports RobotSession::flush() {
  return release({});
}

void RobotSession::use(const Waiting& waiting, PoseReports& reports) {
  ++taken_;
  if (const auto* step = std::get_if<Stepped>(&waiting.what))
    use(waiting.stamp, *step, reports);
  else if (const auto* scan = std::get_if<localization::LaserScan>(&waiting.what))
    feed(waiting.stamp, *scan, reports);
  else if (const auto* fix = std::get_if<localization::GnssFix>(&waiting.what))
    feed(waiting.stamp, *fix, reports);
  else
    feed(waiting.stamp, std::get<localization::HeadingFix>(waiting.what), reports);
}

void RobotSession::use(Stamp stamp, const Stepped& step, PoseReports& reports) {
  const std::optional<Stepped> last = std::exchange(last_odometry_, step);
  if (last) {
    const double seconds = step.odom.t - last->odom.t;
    gaps_ += seconds > settings_.max_gap;
    longest_gap_ = std::max(longest_gap_, seconds);
  }
  const std::size_t before = reports.size();
  if (settings_.odometry == OdometryUse::twist) {
    feed(stamp, localization::TwistReading{step.forward, step.left, step.turn}, reports);
  } else if (last) {
    std::vector<localization::StampedPose> poses{last->odom, step.odom};
    if (settings_.odometry == OdometryUse::pose_with_gyro) {
      poses = importers::with_yaw_of_gyro(std::move(poses), rates_);
      const auto used = std::ranges::upper_bound(rates_, last->odom.t, {}, &importers::TurnRate::t);
      if (used - rates_.begin() > 1) rates_.erase(rates_.begin(), used - 1);
    }
    feed(stamp, localization::StepReading{inverse(poses[0].pose) * poses[1].pose}, reports);
  }
  odom_ = step.odom.pose;
  if (!live_->has_begun()) return;
  reckoned_ = live_->replay().dead_reckoning();
  if (reports.size() > before) *last_report_ = reports.back() = report(stamp, false);
}

void RobotSession::feed(Stamp stamp, localization::LogReading reading, PoseReports& reports) {
  if (!live_->has_begun()) return drop("the start of the robot is not known yet");
  localization::RobotLog readings;
  if (std::holds_alternative<localization::GnssFix>(reading)) readings.fix_crs = "EPSG:4326";
  readings.events.push_back({seconds_of(stamp), std::move(reading)});
  const localization::Track& track = live_->replay().track();
  const std::size_t rows = track.rows.size();
  const std::int64_t updates = track.updates;
  live_->take(std::move(readings));
  if (track.rows.size() == rows) return drop("a satellite fix has no position in the CRS of the map");
  live_->forget_rows();
  const bool looked = track.updates > updates;
  last_report_ = report(stamp, looked);
  if (looked) mark_sightings();
  reports.push_back(*last_report_);
}

PoseReport RobotSession::report(Stamp stamp, bool looked) const {
  const localization::TrackRow& row = live_->replay().track().rows.back();
  PoseReport report{.stamp = stamp,
                    .at = row.at,
                    .z = row.z,
                    .turn = turn_of(row.roll, row.pitch, row.at.pose.yaw),
                    .covariance = in_space(row.at.covariance),
                    .map_from_odom = {},
                    .status = live_->localizer().status(),
                    .matched = row.matched,
                    .rejected = row.rejected,
                    .looked = looked};
  if (!last_odometry_) return report;
  const localization::Pose2 shift = row.at.pose * inverse(odom_from_base());
  report.map_from_odom =
      Pose{.at = {shift.x, shift.y, live_->knows_terrain() ? row.z - last_odometry_->z : 0},
           .turn = turn_of(0, 0, shift.yaw)};
  return report;
}

void RobotSession::mark_sightings() {
  sighting_markers_.clear();
  const localization::SightingSet& seen = live_->replay().seen();
  const std::vector<localization::Match>& matches = live_->replay().matches();
  const localization::Pose2 map_from_sensor = last_report_->at.pose * seen.robot_from_sensor;
  for (std::size_t i = 0; i < matches.size() && i < seen.sightings.size(); ++i) {
    const localization::SeenLandmark& s = seen.sightings[i];
    if (matches[i].verdict == localization::Verdict::matched)
      sighting_markers_.push_back({.name = "matched", .at = matches[i].at});
    else if (s.has_position())
      sighting_markers_.push_back(
          {.name = "rejected",
           .at = (map_from_sensor *
                  localization::Pose2{*s.range * std::cos(*s.bearing), *s.range * std::sin(*s.bearing), 0})
                     .at()});
  }
}

std::vector<Marker> RobotSession::map_markers() const {
  std::vector<Marker> markers;
  for (const localization::MapLandmark& landmark : live_->landmarks())
    markers.push_back(
        {.name = live_->map().types()[landmark.type].name, .at = landmark.at, .diameter = landmark.diameter});
  return markers;
}

SessionStatus RobotSession::status() const {
  using localization::LocalizationStatus;
  SessionStatus status;
  if (!live_->has_begun())
    status = {Health::warning, "waiting for an initial pose", {}};
  else if (!last_report_)
    status = {Health::warning, "waiting for readings", {}};
  else if (last_report_->status == LocalizationStatus::uninitialized)
    status = {Health::warning, "searching the map for the robot", {}};
  else if (last_report_->status == LocalizationStatus::lost)
    status = {Health::error, "lost: the sightings do not agree with the map", {}};
  else
    status = {Health::ok, "tracking", {}};
  const auto add = [&](const std::string& name, const auto& value) {
    status.values.emplace_back(name, std::to_string(value));
  };
  add("readings", taken_);
  add("restarts by clock", restarts_);
  add("gaps in the odometry", gaps_);
  add("longest gap, s", longest_gap_);
  if (live_->has_begun()) {
    const localization::Track& track = live_->replay().track();
    std::int64_t sightings = 0;
    for (const std::int64_t count : track.verdicts) sightings += count;
    const auto matched = track.verdicts[static_cast<std::size_t>(localization::Verdict::matched)];
    add("sightings matched", matched);
    add("sightings rejected", sightings - matched);
    add("fixes", track.fixes);
    add("fixes rejected", track.fixes_rejected);
  }
  for (const auto& [reason, count] : dropped_) add("dropped: " + reason, count);
  return status;
}

}  // namespace waymark::ros
