// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/route_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "core/error.hpp"
#include "geo/point_at_height.hpp"
#include "planning/odometry_belief.hpp"
#include "testbed/drive/drive_readings.hpp"
#include "testbed/drive/odometry_errors.hpp"
#include "workflows/planning/planning_sensor.hpp"
#include "workflows/planning/read_route.hpp"
#include "workflows/sensor_file.hpp"
#include "workflows/simulation/navigator.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;
using localization::Pose2;

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

/// Returns the stations of a route in the grid of a log, metres.
std::vector<Eigen::Vector2d> path_in_grid(const std::vector<RoutePoint>& stations, const RobotMap& map,
                                          const testbed::LogCrs& place) {
  std::vector<Eigen::Vector2d> path;
  for (const RoutePoint& station : stations)
    path.push_back(map.frame.crs_from_map_frame({{station.at.x(), station.at.y(), 0}}).xyz.head<2>() *
                   place.metres_per_unit);
  return path;
}

/// Why a drive ends before its goal.
struct Mishap {
  std::string kind, reason;
};

/// Returns what the truth does to a vehicle. `is_driving`: it did not decide to stop.
std::optional<Mishap> find_mishap(const testbed::Scene& scene, const planning::Vehicle& vehicle,
                                  const testbed::VehicleMotion& motion, bool is_driving, double max_seconds) {
  const testbed::DriveStep& now = motion.now();
  const double steepest = std::max(std::abs(now.at.pitch), std::abs(now.at.roll)) / kRadiansPerDegree;
  if (const std::int64_t rock = touched_rock(scene, now.at.plane, vehicle); rock >= 0) {
    const testbed::TrueRock& hit = scene.rocks[static_cast<std::size_t>(rock)];
    return Mishap{"contact", fmt::format("a rock of {:.2f} m height at {:.1f}, {:.1f}", hit.height,
                                         hit.position.x(), hit.position.y())};
  }
  if (const std::string mishap = motion.mishap(); !mishap.empty())
    return Mishap{mishap == "stuck" ? "stuck" : "tipped_over", "the vehicle is " + mishap};
  if (is_driving && steepest > vehicle.max_slope.value)
    return Mishap{"too_steep", fmt::format("the slope of {:.0f} deg exceeds the vehicle's {:.0f}", steepest,
                                           vehicle.max_slope.value)};
  if (is_driving && now.t > max_seconds) return Mishap{"time", "ten times the time of the plan has passed"};
  return std::nullopt;
}

/// Compares the estimated track with the true steps.
void score_against_steps(DriveReport& report, const localization::Track& track,
                         std::span<const testbed::DriveStep> steps, const testbed::LogCrs& place,
                         const geo::LocalFrame& frame) {
  report.seconds = steps.back().t, report.driven = steps.back().distance;
  localization::RobotLog truth;
  truth.in_crs = place.crs != "local";
  for (const testbed::DriveStep& step : steps)
    truth.truth.push_back({step.t,
                           {step.at.plane.x / place.metres_per_unit, step.at.plane.y / place.metres_per_unit,
                            step.at.plane.yaw}});
  localization::convert_to_map_frame(truth, frame);
  score_drive(report, track, truth.truth);
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
  const std::vector<Eigen::Vector2d> planned = path_in_grid(stations, map, place);
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
  const testbed::OdometryErrors errors =
      testbed::odometry_errors(settings, planned_steps(scene.terrain, planned, settings.wheels));
  const planning::Odometry odometry{errors.noise, errors.drift, settings.speed};
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
  std::vector<std::string> dem;
  if (!model.dem.empty()) dem.push_back(resolved(folder, model.dem));
  const localization::LandmarkGrid landmarks(all_landmarks(map, sensor.get()));
  Eigen::AlignedBox2d sight_area = landmarks.bounds();
  sight_area.min().array() -= coverage.range, sight_area.max().array() += coverage.range;
  Navigator navigator(model, vehicle, settings.speed, settings.laser_height, live,
                      DrivePlanner(landmarks,
                                   {.coverage = coverage,
                                    .cell = model.cell,
                                    .limit_sigma = model.limit_sigma,
                                    .clearance = vehicle.track_width() / 2 + model.margin,
                                    .noise = odometry.white(),
                                    .visible = planning_line_of_sight(
                                        map, dem, {.sensor_height = settings.laser_height}, sight_area)},
                                   hazards),
                      stations, report);
  const auto motion = testbed::make_motion(scene.terrain, scene.solids, settings, start, world.seed);
  testbed::DriveSensors sensors(world, place);
  std::vector<testbed::DriveStep> steps;
  drive.log = header;
  double keep_out = 0, distance = 0;
  const double max_seconds = 600 + 10 * report.planned_length / settings.speed;
  for (std::size_t i = 0; report.ended.empty(); ++i) {
    const testbed::DriveStep now = motion->now();
    for (const std::string& line : sensors.lines(i, now)) {
      drive.log += line;
      const std::int64_t sets = live.replay().track().updates;
      live.take(line);
      if (live.replay().track().updates > sets) navigator.look(now.t);
    }
    auto command = navigator.decide(now.t, now.distance);
    if (const auto mishap = find_mishap(scene, vehicle, *motion, command.has_value(), max_seconds)) {
      report.ended = mishap->kind, report.reached = false;
      if (mishap->kind == "contact") report.contact = mishap->reason;
      report.events.push_back({now.t, live.localizer().estimate().pose.at(), "ended", mishap->reason});
      command.reset();
    }
    const testbed::DriveStep done = command ? motion->step(*command) : now;
    steps.push_back(done);
    const std::string lines = testbed::odometry_lines(world, place, done);
    drive.log += lines;
    live.take(lines);
    const Eigen::Vector2d at = plan_position(map.frame, now.at.plane.x / place.metres_per_unit,
                                             now.at.plane.y / place.metres_per_unit);
    if (hazards && hazards->at(at.x(), at.y()) >= planning::HazardClass::hazard)
      keep_out += now.distance - distance;
    distance = now.distance;
    report.goal_distance = (at - stations.back().at).norm();
  }
  if (hazards) report.keep_out = keep_out;
  drive.track = live.replay().track();
  score_against_steps(report, drive.track, steps, place, map.frame);
  testbed::DriveWorld driven = world;
  driven.steps = std::move(steps);
  drive.true_track = testbed::true_track(driven, place);
  return drive;
}

}  // namespace waymark::workflows
