// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/route.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/options/option_reader.hpp"
#include "core/rotate_axes.hpp"
#include "geo/axes_rotation.hpp"
#include "geodb/map_store.hpp"
#include "geodb/write_map.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/robot_log.hpp"
#include "planning/vehicle.hpp"
#include "workflows/localization/robot_map.hpp"
#include "workflows/planning/leg_planner.hpp"
#include "workflows/planning/path_clearance.hpp"
#include "workflows/planning/planning_sensor.hpp"
#include "workflows/planning/route_cells.hpp"
#include "workflows/planning/route_layers.hpp"
#include "workflows/planning/route_progress.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::workflows {
namespace {

void check(const RouteRequest& request) {
  const int objectives = (request.limit_sigma > 0) + (request.keep_landmarks > 0) + (request.weight > 0) +
                         (request.min_sigma ? 1 : 0);
  const auto refuse = [](const std::string& problem, const std::string& hint) {
    throw Error(ErrorCode::usage, problem, "", hint);
  };
  for (const auto& [name, value] : {std::pair("--start-sd", request.start_sd),
                                    {"--range", request.range},
                                    {"--view", request.view},
                                    {"--limit-sigma", request.limit_sigma},
                                    {"--keep-landmarks", request.keep_landmarks},
                                    {"--weight", request.weight}})
    if (!(value >= 0)) refuse(fmt::format("{} {:g} is negative", name, value), "");
  if (objectives != 1)
    refuse(objectives ? "more than one objective is given" : "the route has no objective",
           "pass one of --limit-sigma M, --keep-landmarks N, --weight W, each above 0, or --least-sigma");
  if (request.by_quality && !(request.keep_landmarks > 0))
    refuse("--by-quality is about the landmarks to keep in sight",
           "pass --keep-landmarks N, or leave it out");
  static_cast<void>(planning::find_vehicle(request.vehicle));  // throws for an unknown one
  check_number("--cell", request.cell, "m", {.help = "", .min = 0.1, .max = 1000});
  if (!(request.speed > 0)) refuse(fmt::format("--speed {:g} is not above 0 m/s", request.speed), "");
  if (request.worlds < 1 || request.alternatives < 1)
    refuse("--worlds and --alternatives are at least 1", "");
  check_number("--worlds", static_cast<double>(request.worlds), "", {.help = "", .min = 1, .max = 1e5});
  check_number("--view", request.view, "deg", {.help = "", .min = 0, .max = 360});
  check_number("--range", request.range, "m", {.help = "", .min = 0, .max = 1e5});
  keep_inputs(request.output, {request.map, request.aoi, request.hazards, request.odometry, request.sensor});
  keep_inputs(request.output, request.dem);
  const std::string extension = std::filesystem::path(request.output).extension();
  if (extension != ".gpkg" && extension != ".geojson" && extension != ".csv")
    refuse(fmt::format("the route '{}' does not end in .gpkg, .geojson or .csv", request.output), "");
}

/// Returns the odometry that a log states. Sets the start's uncertainty if the log has it.
planning::Odometry read_odometry(const RouteRequest& request, const RobotMap& map, double& start_sd,
                                 double& start_yaw_sd) {
  planning::Odometry odometry{.speed = request.speed};
  if (request.odometry.empty()) return odometry;
  const localization::RobotLog log = importers::import_log(request.odometry, map.types());
  if (!log.odometry)
    throw Error(ErrorCode::input, "the log states no odometry noise", request.odometry,
                "add \"odometry_noise\" to its header, or leave --odometry out");
  odometry.noise = *log.odometry, odometry.drift = log.drift;
  if (log.start_sd > 0) start_sd = log.start_sd, start_yaw_sd = log.start_yaw_sd;
  return odometry;
}

/// Throws Error{usage} for waypoints that one cell takes for the same position.
void check_resolved(const std::vector<Waypoint>& points, const std::vector<std::int64_t>& stops,
                    const planning::RouteCells& cells) {
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const double apart = (points[i + 1].at - points[i].at).norm();
    if (stops[i] != stops[i + 1] || apart <= cells.cell / 10) continue;
    throw Error(ErrorCode::usage,
                fmt::format("{} and {} lie in one cell of {:g} m, {:.3g} m apart", points[i].text,
                            points[i + 1].text, cells.cell, apart),
                "", fmt::format("--cell {:.2g}", apart / 2));
  }
}

[[noreturn]] void fail_between(const RouteRequest& request, const Waypoint& from, const Waypoint& to) {
  const bool has_hazards = request.hazards != "none";
  const std::string between = !has_hazards ? "terrain outside the area of interest lies"
                              : request.aoi.empty()
                                  ? "hazards and unknown terrain lie"
                                  : "hazards, unknown terrain or the border of the area lie";
  throw Error(ErrorCode::input, fmt::format("there is no route from {} to {}", from.text, to.text),
              has_hazards ? request.hazards : request.aoi,
              between + " between; make --cell finer" +
                  (has_hazards ? ", or pass --hazards none" : ", or the area larger"));
}

using Uids = std::map<std::uint64_t, std::string>;

/// Returns the uids of the three landmarks that inform most at a pose.
std::vector<std::string> important_landmarks(const LegPlanner& planner, const Uids& uids,
                                             const localization::Pose2& pose) {
  const localization::LandmarkGrid& landmarks = planner.landmarks;
  const planning::LandmarkSensing& sensing = planner.sensing;
  std::vector<std::pair<double, std::string>> found;
  planning::visit_information(pose, landmarks, sensing, [&](std::uint32_t i, const planning::Symmetric3& j) {
    if (landmarks[i].quality < sensing.min_confidence) return;
    const auto uid = uids.find(landmarks[i].key);
    found.emplace_back(-(j.xx + j.yy) * landmarks[i].quality, uid == uids.end() ? "" : uid->second);
  });
  std::ranges::sort(found);
  std::vector<std::string> first;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, found.size()); ++i) first.push_back(found[i].second);
  return first;
}

/// Describes a route that ends in the cell of `goal`. The belief at the goal is that in the middle of its
/// cell.
PlannedRoute describe(const LegPlanner& planner, const RobotMap& map, const Uids& uids,
                      const std::vector<planning::Route>& legs, const Eigen::Vector2d& goal) {
  const planning::RouteProblem& problem = planner.problem;
  PlannedRoute route;
  const planning::RouteCells& cells = problem.field.cells;
  std::vector<planning::RouteNode> nodes;
  planning::Route whole;
  for (const planning::Route& leg : legs) {
    route.length += leg.length, route.outside += leg.outside;
    nodes.insert(nodes.end(), leg.nodes.begin() + (nodes.empty() ? 0 : 1), leg.nodes.end());
  }
  whole.nodes = nodes;
  planning::WorldBeliefs beliefs = *planner.at_start;
  std::vector<double> worst =
      planning::follow_route(beliefs, problem, planner.landmarks, planner.sensing, whole);
  nodes = whole.nodes;
  route.worst_sd = whole.worst_sd;
  double distance = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const planning::RouteNode& node = nodes[k];
    const double x = cells.x(node.cell), y = cells.y(node.cell);
    const double length = k ? std::hypot(x - cells.x(nodes[k - 1].cell), y - cells.y(nodes[k - 1].cell)) : 0;
    distance += length;
    const localization::Pose2 pose = planning::heading_pose(x, y, node.heading);
    const planning::Information& seen = problem.field.get(node.cell, node.heading);
    if (seen.landmarks == 0) route.without_landmarks += length;
    const double rotation = grid_rotation(map.frame, {x, y});
    route.stations.push_back({map.frame.crs_from_map_frame({{x, y, 0}}).xyz.head<2>(), distance,
                              localization::wrap_angle(pose.yaw + rotation),
                              planning::symmetric(rotate_axes(node.covariance.matrix(), rotation)),
                              position_sd(node.covariance), seen.landmarks,
                              important_landmarks(planner, uids, pose)});
  }
  const planning::RouteNode& last = nodes.back();
  const Eigen::Vector2d rest = goal - Eigen::Vector2d(cells.x(last.cell), cells.y(last.cell));
  if (rest.norm() > 1e-6 * cells.cell) {
    RouteStation end = route.stations.back();
    end.at = map.frame.crs_from_map_frame({{goal.x(), goal.y(), 0}}).xyz.head<2>();
    end.distance += rest.norm();
    end.yaw = localization::wrap_angle(std::atan2(rest.y(), rest.x()) + grid_rotation(map.frame, goal));
    if (end.landmarks == 0) route.without_landmarks += rest.norm();
    route.length += rest.norm();
    route.stations.push_back(std::move(end));
  }
  route.final_sd = route.stations.back().sd;
  std::ranges::sort(worst, std::greater<>());
  for (const double sd : worst) route.worlds_mean += sd / double(worst.size());
  const std::size_t tenth = std::max<std::size_t>(1, worst.size() / 10);
  for (std::size_t i = 0; i < tenth; ++i) route.worlds_worst_tenth += worst[i] / double(tenth);
  return route;
}

/// Returns the box of the cells and of what is seen from them.
Eigen::AlignedBox2d sight_area(const planning::RouteCells& cells, double range) {
  const Eigen::Vector2d first(cells.x0, cells.y0), margin(range, range);
  const Eigen::Vector2d last(cells.x(cells.count() - 1), cells.y(cells.count() - 1));
  return {first - margin, last + margin};
}

planning::InformationField compute_field(const planning::RouteCells& cells, const LegPlanner& planner,
                                         const Callbacks& callbacks) {
  pipeline::ProgressMeter meter(callbacks.progress, "information", 1);
  pipeline::UnitProgress field(meter);
  auto computed =
      planning::make_information_field(cells, planner.problem.passable, planner.landmarks, planner.sensing,
                                       [&](double done) { field.advance_to(done); });
  meter.finish();
  return computed;
}

void check_limit(const RouteRequest& request, double start_sd) {
  if (request.limit_sigma > 0 && request.limit_sigma < start_sd)
    throw Error(ErrorCode::usage,
                fmt::format("the sd at the start, {:g} m, exceeds the limit of {:g} m", start_sd,
                            request.limit_sigma),
                "", "raise --limit-sigma, or give the start's --start-sd");
}

/// The legs from waypoint to waypoint. Each begins with the belief at the end of the one before.
struct LegSequence {
  const RouteRequest& request;
  LegPlanner& planner;
  const std::vector<Waypoint>& points;
  const std::vector<std::int64_t>& stops;
  planning::Symmetric3 start;

  /// Searches each leg by `search`, which takes at most `max_searches` searches. Throws if there is no way.
  template <class Search>
  std::vector<planning::Route> follow(int max_searches, Search&& search) const {
    planning::RouteProblem& problem = planner.problem;
    std::vector<planning::Route> legs;
    problem.start = start;
    planner.before = planner.at_start;
    problem.heading.reset();
    if (points[0].yaw)
      problem.heading = static_cast<int>((std::lround(*points[0].yaw / (std::numbers::pi / 4)) % 8 + 8) % 8);
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      planner.begin_leg(stops[i], stops[i + 1]);
      planner.progress->begin_leg(max_searches);
      planner.worlds_agree = i == 0;
      if (!std::isfinite(problem.to_go[planning::slot(problem.from)]))
        fail_between(request, points[i], points[i + 1]);
      legs.push_back(search());
      planning::follow_route(*planner.before, problem, planner.landmarks, planner.sensing, legs.back());
      problem.start = legs.back().nodes.back().covariance;
      problem.heading = legs.back().nodes.back().heading;
      planner.progress->end_leg();
    }
    problem.start = start;
    return legs;
  }
};

/// Returns a length, m, that no route within the limit is shorter than: cells that the relaxed test excludes
/// cannot lie on it.
double min_length(const RouteRequest& request, LegPlanner& planner, const planning::RouteCells& cells,
                  const std::vector<std::int64_t>& stops) {
  planning::RouteProblem& problem = planner.problem;
  double length = 0;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    problem.from = stops[i], problem.to = stops[i + 1];
    std::vector<char> reached = problem.passable;
    if (i == 0) {
      const std::vector<double> bound = planner.min_sd_in_any_world(request.limit_sigma);
      for (std::size_t k = 0; k < reached.size(); ++k) reached[k] = std::isfinite(bound[k]) ? 1 : 0;
    }
    length += planning::distances_to(cells, reached, problem.to)[planning::slot(problem.from)];
  }
  return length;
}

std::string summary_of(const RouteRequest& request, const RouteResult& result) {
  const PlannedRoute& best = result.routes.front();
  std::string text = fmt::format(
      "{}: {:.1f} m, worst sd {:.2f} m, at the goal {:.2f} m, {:.0f} m without a landmark in sight\n"
      "  over {} worlds: worst sd {:.2f} m on average, {:.2f} m in the worst tenth\n"
      "  shortest route: {:.1f} m, worst sd {:.2f} m\n"
      "  on cells of {:g} m and eight headings",
      request.output, best.length, best.worst_sd, best.final_sd, best.without_landmarks, request.worlds,
      best.worlds_mean, best.worlds_worst_tenth, result.shortest.length, result.shortest.worst_sd,
      request.cell);
  if (request.limit_sigma > 0)
    text += fmt::format(", no route that keeps the limit is shorter than {:.1f} m", result.lower_bound);
  if (request.keep_landmarks > 0)
    text += fmt::format(", {:.1f} m with fewer than {:g} landmarks in sight", best.outside,
                        request.keep_landmarks);
  return text;
}

}  // namespace

RouteResult plan_route(const RouteRequest& request, const Callbacks& callbacks) {
  check(request);
  const std::shared_ptr<const SensorProfile> sensor = find_sensor(request.sensor, request.map);
  const SensorCoverage coverage = planning_coverage(*sensor, request.sensor, request.range, request.view);
  OpenedMap opened = open_robot_map(request.map, sensor.get());
  const RobotMap& map = opened.map;
  std::vector<Waypoint> points{parse_waypoint("--from", request.from, map)};
  for (const std::string& via : request.via) points.push_back(parse_waypoint("--via", via, map));
  points.push_back(parse_waypoint("--to", request.to, map));

  std::optional<HazardClasses> hazards;
  if (request.hazards != "none") hazards.emplace(request.hazards, map);
  const HazardClasses* classes = hazards ? &*hazards : nullptr;
  LegPlanner planner(request, localization::LandmarkGrid(all_landmarks(map, sensor.get())), coverage);
  Uids uids;
  for (const Landmark& landmark : map.store->query({}))
    uids[localization::landmark_key(landmark.uid)] = landmark.uid;
  const std::string& closing = hazards ? request.hazards : request.aoi;
  check_known(points, classes, closing);
  planning::RouteCells cells = cells_for(points, request.cell, coverage.range);
  // The route begins where the vehicle is, in the middle of a cell.
  cells.x0 += std::remainder(points[0].at.x() - cells.x0, cells.cell);
  cells.y0 += std::remainder(points[0].at.y() - cells.y0, cells.cell);
  planning::RouteProblem& problem = planner.problem;
  problem.passable = passable_cells(cells, classes);
  if (!request.aoi.empty()) close_outside(request.aoi, map, points, cells, problem.passable);
  std::vector<std::int64_t> stops;
  for (const Waypoint& point : points)
    stops.push_back(cell_of(point, cells, problem.passable, classes, closing));
  check_resolved(points, stops, cells);
  planner.sensing.identities_known = request.identities_known;
  planner.sensing.visible = planning_line_of_sight(map, request.dem, {.sensor_height = request.sensor_height},
                                                   sight_area(cells, coverage.range), callbacks);
  problem.field = compute_field(cells, planner, callbacks);
  double sd = 0.1, yaw_sd = 2 * kRadiansPerDegree;
  planner.odometry = read_odometry(request, map, sd, yaw_sd);
  if (request.start_sd > 0) sd = request.start_sd;
  check_limit(request, sd);
  problem.noise = planner.odometry.white();
  problem.start = {sd * sd, 0, sd * sd, 0, 0, yaw_sd * yaw_sd};
  planner.at_start.emplace(problem.start, planner.odometry, planner.landmarks, request.worlds, request.seed);

  const auto leg_count = static_cast<std::int64_t>(stops.size() - 1);
  const std::int64_t more_routes = std::min<std::int64_t>(request.alternatives - 1, 1000);
  RouteProgress progress(callbacks.progress,
                         leg_count * (1 + planner.max_searches() + kMaxSearches * more_routes));
  planner.progress = &progress;
  problem.advanced = [&](double done) { progress.advance(done); };
  const LegSequence sequence{request, planner, points, stops, problem.start};

  const Eigen::Vector2d goal = points.back().at;
  RouteResult result;
  result.shortest =
      describe(planner, map, uids, sequence.follow(1, [&] { return *planner.search({.labels = 1}); }), goal);
  result.routes.push_back(describe(
      planner, map, uids, sequence.follow(planner.max_searches(), [&] { return planner.leg(); }), goal));
  for (std::int64_t i = 1; i < request.alternatives; ++i) {
    // Along the front of length and worst sd: the next route is a tenth better, as far as one exists.
    const double limit = 0.9 * result.routes.back().worst_sd;
    bool found = true;
    const auto legs = sequence.follow(kMaxSearches, [&] {
      auto route = planner.keep(limit);
      found = found && route;
      return route ? *route : *planner.search({.labels = 1});
    });
    if (!found) break;
    result.routes.push_back(describe(planner, map, uids, legs, goal));
  }
  if (request.limit_sigma > 0) result.lower_bound = min_length(request, planner, cells, stops);
  progress.finish();
  const std::string clearance = add_clearance(request, map, result);
  write_routes(request, map.crs(), result);
  callbacks.summary(summary_of(request, result) + "\n" + clearance);
  return result;
}

}  // namespace waymark::workflows
