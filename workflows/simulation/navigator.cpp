// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/navigator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "testbed/drive/drive_route.hpp"

namespace waymark::workflows {
namespace {

using localization::Pose2;

constexpr double kPathSpacing = 0.5;  // m between points of a path
constexpr double kLookAhead = 12;     // m of the path that must be free of obstacles
constexpr double kStopBefore = 4;     // m to an obstacle that was seen once
constexpr int kLooks = 3;             // sets of sightings that rule an obstacle out
constexpr double kBetweenPlans = 10;  // m driven between two plans for the sake of the sd
constexpr double kMaxLost = 60;       // s
constexpr double kOverSd = 0.1;       // m by which the sd may exceed the plan in any case

PlannedPath path_of(const std::vector<RoutePoint>& stations) {
  std::vector<Eigen::Vector2d> corners;
  for (const RoutePoint& s : stations) corners.push_back(s.at);
  PlannedPath path{testbed::smooth_path(corners, kPathSpacing), {}};
  std::size_t nearest = 0;
  for (const Eigen::Vector2d& at : path.points) {
    // Stations are passed in their order, so that the path may cross itself.
    while (nearest + 1 < stations.size() &&
           (stations[nearest + 1].at - at).norm() <= (stations[nearest].at - at).norm())
      ++nearest;
    path.sd.push_back(stations[nearest].sd);
  }
  return path;
}

double length_of(const std::vector<Eigen::Vector2d>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

}  // namespace

Navigator::Navigator(const testbed::NavigationModel& model, const planning::Vehicle& vehicle, double speed,
                     double scanner_height, const LiveLocalizer& live, DrivePlanner planner,
                     const std::vector<RoutePoint>& stations, DriveReport& report)
    : model_(model),
      vehicle_(vehicle),
      speed_(speed),
      scanner_height_(scanner_height),
      live_(live),
      planner_(std::move(planner)),
      watch_(planner_.landmarks(), planner_.sensing()),
      report_(report),
      goal_(stations.back().at) {
  follow(stations);
  report_.planned_length = length_of(path_.points);
  for (const RoutePoint& s : stations) report_.planned_sd = std::max(report_.planned_sd, s.sd);
}

void Navigator::look(double t) {
  t_ = t;
  const localization::PoseEstimate pose = live_.localizer().estimate();
  watch_.add(pose, live_.replay().matches());
  if (!model_.avoid) return;
  std::vector<planning::HazardObject> seen;
  for (const localization::SeenLandmark& s : live_.replay().seen().sightings)
    seen.push_back(planning::hazard_seen(s, live_.replay().seen().robot_from_sensor, live_.map().types(),
                                         vehicle_, scanner_height_));
  memory_.add(seen, live_.replay().dead_reckoning());
  if (looks_ > 0) --looks_;
  looked_ = true;
}

std::optional<testbed::DriveCommand> Navigator::decide(double t, double driven) {
  t_ = t;
  const localization::PoseEstimate pose = live_.localizer().estimate();
  if (live_.localizer().status() != localization::LocalizationStatus::lost) lost_since_ = t;
  if (t - lost_since_ > kMaxLost) return end("lost", "no sighting agrees with the map");
  if (std::exchange(looked_, false) && model_.avoid && !avoid_obstacles(pose)) return {};
  if (looks_ > 0) return testbed::DriveCommand{0, 0};
  if (model_.replans > 0 && driven - planned_at_ >= kBetweenPlans) check_plan(pose, driven);
  const auto command = pursuit_->command(pose.pose);
  if (!command) return end("goal", "");
  return command;
}

std::optional<testbed::DriveCommand> Navigator::end(const std::string& kind, const std::string& reason) {
  report_.ended = kind, report_.reached = kind == "goal";
  note("ended", reason.empty() ? kind : reason);
  return {};
}

void Navigator::note(const std::string& kind, const std::string& reason) {
  report_.events.push_back({t_, live_.localizer().estimate().pose.at(), kind, reason});
}

void Navigator::follow(const std::vector<RoutePoint>& stations) {
  path_ = path_of(stations);
  pursuit_.emplace(path_.points, speed_);
}

std::vector<planning::SeenObstacle> Navigator::obstacles(const Pose2& pose) const {
  const Pose2 map_from_odometry = pose * localization::inverse(live_.replay().dead_reckoning());
  std::vector<planning::SeenObstacle> all = memory_.obstacles();
  for (planning::SeenObstacle& o : all) o.at = (map_from_odometry * Pose2{o.at.x(), o.at.y(), 0}).at();
  return all;
}

bool Navigator::avoid_obstacles(const localization::PoseEstimate& pose) {
  const auto all = obstacles(pose.pose);
  bool blocked = false, doubtful = false;
  const auto& points = path_.points;
  double ahead = 0;
  Eigen::Vector2d before = pose.pose.at();
  for (std::size_t i = pursuit_->target(); i < points.size() && ahead < kLookAhead; ++i) {
    ahead += (points[i] - before).norm(), before = points[i];
    for (const planning::SeenObstacle& o : all) {
      // A vehicle beside an obstacle may drive away from it.
      const double apart = (points[i] - o.at).norm();
      if (!(apart < o.radius + planner_.settings().clearance) ||
          !(apart < (pose.pose.at() - o.at).norm() - 0.05))
        continue;
      blocked = blocked || o.confirmed();
      doubtful = doubtful || (!o.confirmed() && ahead < kStopBefore + o.radius);
    }
  }
  if (blocked) return detour(pose, "an obstacle on the path");
  if (doubtful && looks_ == 0 && was_doubtful_) {
    memory_.confirm_all();
    return detour(pose, "an obstacle that could not be ruled out");
  }
  if (doubtful && looks_ == 0) {
    looks_ = kLooks, ++report_.stops, was_doubtful_ = true;
    note("stopped", "an obstacle ahead was seen once");
  } else if (!doubtful && was_doubtful_) {
    looks_ = 0, was_doubtful_ = false;
    note("ruled_out", "the obstacle was not seen again");
  }
  return true;
}

std::size_t Navigator::rejoin_at(const std::vector<planning::SeenObstacle>& all) const {
  const auto& points = path_.points;
  const std::size_t first = pursuit_->target() + static_cast<std::size_t>(kLookAhead / kPathSpacing);
  const double clear = planner_.settings().clearance + planner_.settings().cell;
  for (std::size_t i = first; i < points.size(); ++i)
    if (std::ranges::none_of(all,
                             [&](const auto& o) { return (points[i] - o.at).norm() < o.radius + clear; }))
      return i;
  return points.size() - 1;
}

bool Navigator::detour(const localization::PoseEstimate& pose, const std::string& reason) {
  auto confirmed = obstacles(pose.pose);
  std::erase_if(confirmed, [](const planning::SeenObstacle& o) { return !o.confirmed(); });
  const std::size_t back = rejoin_at(confirmed);
  if (report_.replans >= model_.replans || back + 1 == path_.points.size()) return replan(pose, reason);
  auto plan = planner_.plan({pose, path_.points[back], confirmed, gone_});
  if (!plan) return replan(pose, reason);
  ++report_.replans, looks_ = 0, was_doubtful_ = false;
  for (std::size_t i = back + 1; i < path_.points.size(); ++i)
    plan->points.push_back({path_.points[i], path_.sd[i]});
  follow(plan->points);
  note("replanned", fmt::format("{}: a detour of {:.1f} m back to the route", reason, plan->length));
  return true;
}

bool Navigator::replan(const localization::PoseEstimate& pose, const std::string& reason) {
  looks_ = 0, was_doubtful_ = false;
  if (report_.replans >= model_.replans) {
    end(model_.replans ? "gave_up" : "hazard",
        fmt::format("{}, and {} new routes were planned", reason, report_.replans));
    return false;
  }
  ++report_.replans;
  auto confirmed = obstacles(pose.pose);
  std::erase_if(confirmed, [](const planning::SeenObstacle& o) { return !o.confirmed(); });
  const auto plan = planner_.plan({pose, goal_, confirmed, gone_});
  if (!plan) {
    end("no_route", fmt::format("{}, and hazards leave no route to the goal", reason));
    return false;
  }
  follow(plan->points);
  note("replanned", fmt::format("{}: {:.1f} m to go, worst sd {:.2f} m{}", reason, plan->length,
                                plan->worst_sd, plan->keeps_limit ? "" : ", no route keeps the limit"));
  return true;
}

void Navigator::check_plan(const localization::PoseEstimate& pose, double driven) {
  const double sd = planning::position_sd(planning::symmetric(pose.covariance));
  const double planned = path_.sd[std::min(pursuit_->target(), path_.sd.size() - 1)];
  const auto gone = watch_.gone();
  const std::span rest(path_.points.begin() + static_cast<std::ptrdiff_t>(pursuit_->target()),
                       path_.points.end());
  const double limit = model_.limit_sigma;
  if (planned > 0 && sd > model_.sd_factor * planned + kOverSd) {
    // A plan that keeps the limit from here, too, stays.
    if (limit > 0 && planner_.expected_sd(pose, rest, gone) <= limit) return;
    planned_at_ = driven + (sd > limit ? kBetweenPlans : 0), gone_ = gone;
    replan(pose, fmt::format("the sd of {:.2f} m exceeds the planned {:.2f} m", sd, planned));
  } else if (gone.size() > gone_.size()) {
    planned_at_ = driven;
    const double with = planner_.expected_sd(pose, rest, gone_);
    const double without = planner_.expected_sd(pose, rest, gone);
    const bool matters = without > std::max(limit, model_.sd_factor * with);
    const std::size_t more = gone.size() - gone_.size();
    gone_ = gone;
    if (matters)
      replan(pose, fmt::format("{} landmarks are gone: the sd would grow to {:.2f} m", more, without));
  }
}

}  // namespace waymark::workflows
