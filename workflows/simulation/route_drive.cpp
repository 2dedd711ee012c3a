// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/route_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "planning/landmark_watch.hpp"
#include "testbed/drive/drive_readings.hpp"
#include "testbed/drive/drive_route.hpp"
#include "workflows/localization/live_localizer.hpp"
#include "workflows/planning/drive_planner.hpp"
#include "workflows/planning/planning_sensor.hpp"
#include "workflows/planning/read_route.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;
using localization::Pose2;

constexpr double kPathSpacing = 0.5;  // m between points of a path
constexpr double kLookAhead = 12;     // m of the path that must be free of obstacles
constexpr double kStopBefore = 4;     // m to an obstacle that was seen once
constexpr int kLooks = 3;             // sets of sightings that rule an obstacle out
constexpr double kBetweenPlans = 10;  // m driven between two plans for the sake of the sd
constexpr double kMaxLost = 60;       // s
constexpr double kOverSd = 0.1;       // m by which the sd may exceed the plan in any case

/// Path of a plan, with the planned sd at each point.
struct Path {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> sd;
};

Path path_of(const std::vector<RoutePoint>& stations) {
  std::vector<Eigen::Vector2d> corners;
  for (const RoutePoint& s : stations) corners.push_back(s.at);
  Path path{testbed::smooth_path(corners, kPathSpacing), {}};
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

/// The vehicle's own part of a drive: what it knows and decides. It never sees the truth.
class Navigator {
 public:
  Navigator(const testbed::NavigationModel& model, const planning::Vehicle& vehicle, double speed,
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

  /// Takes the sightings that the localizer took last.
  void look(double t) {
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

  /// Returns what to do until the next step; `std::nullopt` if the drive has ended.
  std::optional<testbed::DriveCommand> decide(double t, double driven) {
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

 private:
  std::optional<testbed::DriveCommand> end(const std::string& kind, const std::string& reason) {
    report_.ended = kind, report_.reached = kind == "goal";
    note("ended", reason.empty() ? kind : reason);
    return {};
  }
  void note(const std::string& kind, const std::string& reason) {
    report_.events.push_back({t_, live_.localizer().estimate().pose.at(), kind, reason});
  }
  void follow(const std::vector<RoutePoint>& stations) {
    path_ = path_of(stations);
    pursuit_.emplace(path_.points, speed_);
  }

  /// Obstacles in the map frame, by the estimated pose.
  std::vector<planning::SeenObstacle> obstacles(const Pose2& pose) const {
    const Pose2 map_from_odometry = pose * localization::inverse(live_.replay().dead_reckoning());
    std::vector<planning::SeenObstacle> all = memory_.obstacles();
    for (planning::SeenObstacle& o : all) o.at = (map_from_odometry * Pose2{o.at.x(), o.at.y(), 0}).at();
    return all;
  }

  /// Returns false if the drive has ended.
  bool avoid_obstacles(const localization::PoseEstimate& pose) {
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

  /// Returns the first point of the path beyond the obstacles ahead that is clear of them.
  std::size_t rejoin_at(const std::vector<planning::SeenObstacle>& all) const {
    const auto& points = path_.points;
    const std::size_t first = pursuit_->target() + static_cast<std::size_t>(kLookAhead / kPathSpacing);
    const double clear = planner_.settings().clearance + planner_.settings().cell;
    for (std::size_t i = first; i < points.size(); ++i)
      if (std::ranges::none_of(all,
                               [&](const auto& o) { return (points[i] - o.at).norm() < o.radius + clear; }))
        return i;
    return points.size() - 1;
  }

  /// Drives round obstacles and back to the path, or to the goal if that cannot be.
  bool detour(const localization::PoseEstimate& pose, const std::string& reason) {
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

  bool replan(const localization::PoseEstimate& pose, const std::string& reason) {
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

  /// Plans again if the sd exceeds the plan, or if landmarks that the plan counts on are gone.
  void check_plan(const localization::PoseEstimate& pose, double driven) {
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

  const testbed::NavigationModel& model_;
  const planning::Vehicle& vehicle_;
  double speed_, scanner_height_;
  const LiveLocalizer& live_;
  DrivePlanner planner_;
  planning::LandmarkWatch watch_;
  planning::ObstacleMemory memory_;
  DriveReport& report_;
  Eigen::Vector2d goal_;
  Path path_;
  std::optional<testbed::PathPursuit> pursuit_;
  std::vector<localization::LandmarkKey> gone_;
  double t_ = 0, planned_at_ = 0, lost_since_ = 0;
  int looks_ = 0;
  bool was_doubtful_ = false, looked_ = false;
};

std::string resolved(const fs::path& folder, const std::string& file) {
  return fs::path(file).is_absolute() ? file : (folder / file).lexically_normal().string();
}

/// A built-in name stays, a file is relative to the scenario.
std::string resolved_name(const fs::path& folder, const std::string& name) {
  return name.ends_with(".json") ? resolved(folder, name) : name;
}

/// Returns the poses of a vehicle along a planned route: what is known of its slopes before the drive.
std::vector<testbed::DriveStep> planned_steps(const geo::Terrain& terrain,
                                              std::span<const Eigen::Vector2d> path,
                                              const localization::Wheels& wheels) {
  const auto height = [&](const Eigen::Vector2d& p) { return terrain.height(p.x(), p.y()); };
  std::vector<testbed::DriveStep> steps;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector2d along = path[i] - path[i - 1];
    const Pose2 pose{path[i].x(), path[i].y(), std::atan2(along.y(), along.x())};
    if (const auto at = localization::pose_on_terrain(height, pose, wheels)) steps.push_back({.at = *at});
  }
  return steps;
}

}  // namespace

RouteDrive drive_route(const testbed::DriveWorld& world, const testbed::Scene& scene,
                       const testbed::LogCrs& place, const fs::path& folder, const Callbacks& callbacks) {
  const testbed::DriveSettings& settings = world.settings;
  const testbed::NavigationModel& model = settings.navigation;
  const planning::Vehicle vehicle = planning::find_vehicle(resolved_name(folder, model.vehicle));
  const std::string map_file = resolved(folder, model.map), route_file = resolved(folder, settings.route);
  const std::string sensor_name = resolved_name(folder, model.sensor);
  const auto sensor = find_sensor(sensor_name, map_file);
  const SensorCoverage coverage = planning_coverage(*sensor, sensor_name, 0, 0);
  const OpenedMap opened = open_robot_map(map_file, sensor.get());
  const RobotMap& map = opened.map;
  const std::vector<RoutePoint> stations = read_route(route_file, map);
  const auto grid = [&](const Eigen::Vector2d& at) -> Eigen::Vector2d {
    return map.frame.crs_from_map_frame({{at.x(), at.y(), 0}}).xyz.head<2>() * place.metres_per_unit;
  };
  std::vector<Eigen::Vector2d> planned;
  for (const RoutePoint& station : stations) planned.push_back(grid(station.at));
  const Eigen::Vector2d first = planned[0], along = planned[1] - first;
  const Pose2 start{first.x(), first.y(), std::atan2(along.y(), along.x())};
  if (!scene.terrain.height(start.x, start.y))
    throw Error(ErrorCode::input,
                fmt::format("the route begins at {:.1f}, {:.1f}, outside the site", start.x, start.y),
                route_file, "plan it on a map of this site");

  RouteDrive drive;
  DriveReport& report = drive.report;
  report.limit_sigma = model.limit_sigma;
  const std::string header =
      testbed::log_header(world, place, start, planned_steps(scene.terrain, planned, settings.wheels));
  LiveLocalizer live({.map = map_file,
                      .log = {},
                      .method = model.method,
                      .sensor = sensor_name,
                      .use_identities = false,
                      .seed = static_cast<std::int64_t>(world.seed)},
                     header, callbacks);
  std::shared_ptr<const HazardClasses> hazards;
  if (model.hazards != "none")
    hazards = std::make_shared<HazardClasses>(resolved(folder, model.hazards), map);
  Navigator navigator(model, vehicle, settings.speed, settings.laser_height, live,
                      DrivePlanner(localization::LandmarkGrid(all_landmarks(map, sensor.get())),
                                   {.coverage = coverage,
                                    .cell = model.cell,
                                    .limit_sigma = model.limit_sigma,
                                    .clearance = vehicle.track_width() / 2 + model.margin},
                                   hazards),
                      stations, report);
  testbed::SlippingVehicle motion(scene.terrain, settings, start, world.seed);
  testbed::DriveSensors sensors(world, place);
  std::vector<testbed::DriveStep> steps;
  drive.log = header;
  double keep_out = 0, distance = 0;
  const double max_seconds = 600 + 10 * report.planned_length / settings.speed;
  for (std::size_t i = 0; report.ended.empty(); ++i) {
    const testbed::DriveStep now = motion.now();
    for (const std::string& line : sensors.lines(i, now)) {
      drive.log += line;
      const std::int64_t sets = live.replay().track().updates;
      live.take(line);
      if (live.replay().track().updates > sets) navigator.look(now.t);
    }
    auto command = navigator.decide(now.t, now.distance);
    const auto end = [&](const std::string& kind, const std::string& reason) {
      report.ended = kind, report.reached = false;
      report.events.push_back({now.t, live.localizer().estimate().pose.at(), "ended", reason});
      command.reset();
    };
    const double steepest = std::max(std::abs(now.at.pitch), std::abs(now.at.roll)) / kRadiansPerDegree;
    if (const std::int64_t rock = touched_rock(scene, now.at.plane, vehicle); rock >= 0) {
      const testbed::TrueRock& hit = scene.rocks[static_cast<std::size_t>(rock)];
      report.contact = fmt::format("a rock of {:.2f} m height at {:.1f}, {:.1f}", hit.height,
                                   hit.position.x(), hit.position.y());
      end("contact", *report.contact);
    } else if (command && steepest > vehicle.max_slope.value) {
      end("too_steep", fmt::format("the slope of {:.0f} deg exceeds the vehicle's {:.0f}", steepest,
                                   vehicle.max_slope.value));
    } else if (command && now.t > max_seconds) {
      end("time", "ten times the time of the plan has passed");
    }
    const testbed::DriveStep done = command ? motion.step(*command) : now;
    steps.push_back(done);
    const std::string lines = testbed::odometry_lines(world, place, done);
    drive.log += lines;
    live.take(lines);
    const Point<MapFrame> at = map.frame.map_frame_from_crs(
        {{now.at.plane.x / place.metres_per_unit, now.at.plane.y / place.metres_per_unit, 0}});
    if (hazards && hazards->at(at.xyz.x(), at.xyz.y()) >= planning::HazardClass::hazard)
      keep_out += now.distance - distance;
    distance = now.distance;
    report.goal_distance = (at.xyz.head<2>() - stations.back().at).norm();
  }
  if (hazards) report.keep_out = keep_out;
  report.seconds = steps.back().t, report.driven = steps.back().distance;
  drive.track = live.replay().track();
  localization::RobotLog truth;
  truth.in_crs = place.crs != "local";
  for (const testbed::DriveStep& step : steps)
    truth.truth.push_back({step.t,
                           {step.at.plane.x / place.metres_per_unit, step.at.plane.y / place.metres_per_unit,
                            step.at.plane.yaw}});
  localization::convert_to_map_frame(truth, map.frame);
  score_drive(report, drive.track, truth.truth);
  testbed::DriveWorld driven = world;
  driven.steps = std::move(steps);
  drive.true_track = testbed::true_track(driven, place);
  return drive;
}

}  // namespace waymark::workflows
