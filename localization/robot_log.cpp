// SPDX-License-Identifier: Apache-2.0
#include "localization/robot_log.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "geo/axes_rotation.hpp"
#include "geo/point_at_height.hpp"

namespace waymark::localization {
namespace {

constexpr double kSameSquares =
    9.2;                          // squared distance of one landmark's sightings: 99 % of chi-square, 2 dof
constexpr double kForgotten = 4;  // correlation times after which a correlation of 2 % is left
constexpr double kWidest = 1e3;   // limit for two sightings at one time

double widening(double seconds, double memory) {
  if (!(memory > 0)) return 1;
  const double alike = std::exp(-seconds / memory);
  return std::min(std::sqrt((1 + alike) / std::max(1 - alike, 1e-12)), kWidest);
}

bool drives(const LogEvent& e) {
  return std::holds_alternative<TwistReading>(e.what) || std::holds_alternative<CarReading>(e.what) ||
         std::holds_alternative<StepReading>(e.what);
}

bool usable(const LogEvent& e) {
  if (!std::isfinite(e.t)) return false;
  if (const auto* twist = std::get_if<TwistReading>(&e.what))
    return std::isfinite(twist->speed) && std::isfinite(twist->sideways) && std::isfinite(twist->turn);
  if (const auto* car = std::get_if<CarReading>(&e.what))
    return std::isfinite(car->wheel_speed) && std::abs(car->steering) < 1.4;
  if (const auto* step = std::get_if<StepReading>(&e.what)) return step->step.finite();
  if (const auto* fix = std::get_if<GnssFix>(&e.what)) return fix->at.allFinite() && fix->sd > 0;
  if (const auto* fix = std::get_if<HeadingFix>(&e.what)) return std::isfinite(fix->yaw) && fix->sd > 0;
  return true;
}

/// Converts the fixes of a log from their CRS by `placed`, which takes the map's, or omits them.
template <class Placed>
void place_fixes(RobotLog& log, const Crs& map, const Placed& placed) {
  const auto is_fix = [](const LogEvent& e) { return std::holds_alternative<GnssFix>(e.what); };
  const Crs own = Crs::from_text(log.fix_crs);
  if (map.kind() == CrsKind::local || map.body().name != own.body().name) {
    if (const std::size_t omitted = std::erase_if(log.events, is_fix))
      log.remarks.push_back(fmt::format(
          "{} fixes are omitted: they are positions on {}, {}", omitted, own.body().name,
          map.kind() == CrsKind::local ? "and the map has a local CRS" : "the map is of " + map.body().name));
    return;
  }
  const CrsTransform to_map(own, map);
  for (LogEvent& e : log.events)
    if (auto* fix = std::get_if<GnssFix>(&e.what)) {
      const auto [x, y] = to_map(fix->at.x(), fix->at.y());
      fix->at = placed(x, y);
    }
  if (const std::size_t omitted = std::erase_if(log.events, [&](const LogEvent& e) {
        return is_fix(e) && !std::get<GnssFix>(e.what).at.allFinite();
      }))
    log.remarks.push_back(fmt::format("{} fixes are omitted: they lie outside of the map's CRS", omitted));
}

}  // namespace

void RepeatedSightings::predict(const BodyMotion& motion) {
  const MotionCompensation after(motion);
  for (Last& p : last_) after.apply(p.at, p.covariance);
}

void RepeatedSightings::widen(SightingSet& seen, double t) {
  const double longest = kForgotten * std::max(memory_.range, memory_.bearing);
  if (!(longest > 0)) return;
  std::erase_if(last_, [&](const Last& p) { return !(t - p.t < longest); });
  std::vector<bool> taken(last_.size(), false);
  const std::size_t before = last_.size();
  for (SeenLandmark& s : seen.sightings) {
    if (!s.is_valid()) continue;
    if (!s.bearing && s.identity) {
      const auto [last, first] = last_ranges_.try_emplace(*s.identity, t);
      if (!first) s.range_sd *= widening(std::max(0.0, t - last->second), memory_.range);
      last->second = t;
    }
    if (!s.has_position()) continue;
    const double along = seen.robot_from_sensor.yaw + *s.bearing;
    const Eigen::Matrix2d r = Eigen::Rotation2Dd(along).toRotationMatrix();
    const Eigen::Vector2d sd(s.range_sd, *s.range * std::min(s.bearing_sd, 1.0));
    const Last now{.at = seen.robot_from_sensor.at() + r.col(0) * *s.range,
                   .covariance = r * sd.cwiseAbs2().asDiagonal() * r.transpose(),
                   .seen = s,
                   .t = t};
    std::optional<std::size_t> nearest;
    double min_squares = kSameSquares;
    for (std::size_t i = 0; i < before; ++i) {
      if (taken[i] || !may_share_type(last_[i].seen, s)) continue;
      const Eigen::Vector2d d = last_[i].at - now.at;
      const double squares = d.dot((last_[i].covariance + now.covariance).inverse() * d);
      if (squares <= min_squares) min_squares = squares, nearest = i;
    }
    if (!nearest) {
      last_.push_back(now);
      continue;
    }
    taken[*nearest] = true;
    const double seconds = std::max(0.0, t - last_[*nearest].t);
    last_[*nearest] = now;
    s.range_sd *= widening(seconds, memory_.range);
    s.bearing_sd *= widening(seconds, memory_.bearing);
  }
}

void clean_log(RobotLog& log, double max_gap) {
  const auto remark = [&](std::size_t count, const char* what) {
    if (count) log.remarks.push_back(fmt::format("{} {}", count, what));
  };
  remark(std::erase_if(log.events, [](const LogEvent& e) { return !usable(e); }),
         "readings that are not finite are omitted");
  remark(
      std::erase_if(log.truth, [](const StampedPose& p) { return !std::isfinite(p.t) || !p.pose.finite(); }),
      "true poses that are not finite are omitted");
  std::size_t backwards = 0, twice = 0, gaps = 0;
  for (std::size_t i = 1; i < log.events.size(); ++i) backwards += log.events[i].t < log.events[i - 1].t;
  remark(backwards, "times run backwards; the log was sorted by time");
  std::ranges::stable_sort(log.events, {}, &LogEvent::t);
  std::ranges::stable_sort(log.truth, {}, &StampedPose::t);
  std::ranges::stable_sort(log.felled, {}, &FelledReading::t);
  const LogEvent* last = nullptr;
  double widest = 0;
  for (const LogEvent& e : log.events) {
    if (!drives(e)) continue;
    if (last) {
      twice += e.t == last->t;
      gaps += e.t - last->t > max_gap;
      widest = std::max(widest, e.t - last->t);
    }
    last = &e;
  }
  remark(twice, "odometry readings repeat the time of the previous one; the last one is used");
  if (gaps)
    log.remarks.push_back(fmt::format("{} gaps of more than {} s in the odometry, the longest {:.1f} s", gaps,
                                      max_gap, widest));
}

void convert_to_map_frame(RobotLog& log, const LocalFrame& frame) {
  const auto placed = [&](double x, double y) -> Eigen::Vector2d { return plan_position(frame, x, y); };
  const bool own_axes = log.fix_crs.empty();  // else they are east and north
  if (!log.fix_crs.empty()) {
    place_fixes(log, frame.crs(), placed);
    log.fix_crs.clear();
  } else if (log.in_crs) {
    for (LogEvent& e : log.events)
      if (auto* fix = std::get_if<GnssFix>(&e.what)) fix->at = placed(fix->at.x(), fix->at.y());
  }
  if (!log.in_crs) return;
  const auto place = [&](Pose2& pose) {
    const Eigen::Vector2d at = placed(pose.x, pose.y);
    pose = {at.x(), at.y(), wrap_angle(pose.yaw - grid_rotation(frame, at))};
  };
  for (StampedPose& p : log.truth) place(p.pose);
  if (log.start) place(*log.start);
  const Eigen::Vector2d where = log.start           ? log.start->at()
                                : log.truth.empty() ? Eigen::Vector2d(0, 0)
                                                    : log.truth.front().pose.at();
  const double rotation = grid_rotation(frame, where);
  const Eigen::Matrix2d frame_from_crs = Eigen::Rotation2Dd(-rotation).toRotationMatrix();
  for (LogEvent& e : log.events) {
    if (auto* heading = std::get_if<HeadingFix>(&e.what)) heading->yaw = wrap_angle(heading->yaw - rotation);
    if (auto* fix = std::get_if<GnssFix>(&e.what); fix && fix->covariance && own_axes)
      fix->covariance = frame_from_crs * *fix->covariance * frame_from_crs.transpose();
  }
  log.in_crs = false;
}

std::optional<Pose2> pose_at(std::span<const StampedPose> truth, double t, double max_gap) {
  const auto after = std::ranges::lower_bound(truth, t, {}, &StampedPose::t);
  if (after == truth.end()) return {};
  if (after->t == t) return after->pose;
  if (after == truth.begin()) return {};
  const StampedPose &a = *(after - 1), &b = *after;
  if (b.t - a.t > max_gap) return {};
  const double k = (t - a.t) / (b.t - a.t);
  return Pose2{a.pose.x + k * (b.pose.x - a.pose.x), a.pose.y + k * (b.pose.y - a.pose.y),
               wrap_angle(a.pose.yaw + k * wrap_angle(b.pose.yaw - a.pose.yaw))};
}

}  // namespace waymark::localization
