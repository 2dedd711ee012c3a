// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/route.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <numbers>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/options/option_reader.hpp"
#include "geodb/map_store.hpp"
#include "geodb/write_map.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/robot_log.hpp"
#include "planning/sd_bounds.hpp"
#include "planning/world_beliefs.hpp"
#include "workflows/localization/robot_map.hpp"
#include "workflows/planning/path_clearance.hpp"
#include "workflows/planning/planning_sensor.hpp"
#include "workflows/planning/route_cells.hpp"
#include "workflows/planning/route_layers.hpp"
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
           "pass one of --limit-sigma M, --keep-landmarks N, --weight W, --least-sigma");
  check_number("--cell", request.cell, "m", {.help = "", .min = 0.1, .max = 1000});
  if (!(request.speed > 0)) refuse(fmt::format("--speed {:g} is not above 0 m/s", request.speed), "");
  if (request.worlds < 1 || request.alternatives < 1)
    refuse("--worlds and --alternatives are at least 1", "");
  std::error_code missing;
  if (std::filesystem::equivalent(request.output, request.map, missing))
    refuse(fmt::format("the route would replace the map {}", request.map), "name another file");
  const std::string extension = std::filesystem::path(request.output).extension();
  if (extension != ".gpkg" && extension != ".geojson" && extension != ".csv")
    refuse(fmt::format("the route '{}' does not end in .gpkg, .geojson or .csv", request.output), "");
}

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr int kTrials = 8;      // searches for the limit of a search
constexpr double kJust = 0.95;  // of a limit: a route that reaches it is not longer than needed

constexpr std::int64_t kManyLabels = 50'000;  // cells up to which each trial has four labels

std::size_t slot(std::int64_t i) {
  return static_cast<std::size_t>(i);
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

/// Everything that legs of one request share.
struct Planner {
  const RouteRequest& request;
  const RobotMap& map;
  localization::LandmarkGrid landmarks;
  planning::LandmarkSensing sensing;
  planning::RouteProblem problem;
  std::map<std::uint64_t, std::string> uids;
  planning::Odometry odometry = {};
  std::optional<planning::WorldBeliefs> before = {};  ///< at the start of the leg
  bool worlds_agree = true;                           ///< at the start of the leg: all have problem.start

  /// A route of the search, which takes all errors of the odometry as independent and all misses of a
  /// landmark.
  std::optional<planning::Route> search_white(const planning::SigmaSearch& wanted) const {
    return planning::search_by_sigma(problem, wanted);
  }
  /// The same route with the belief over worlds.
  planning::Route with_belief(planning::Route route) const {
    planning::WorldBeliefs beliefs = *before;
    planning::follow_route(beliefs, problem, landmarks, sensing, route);
    return route;
  }
  std::optional<planning::Route> search(const planning::SigmaSearch& wanted) const {
    auto route = search_white(wanted);
    return route ? std::optional(with_belief(std::move(*route))) : std::nullopt;
  }

  /// Returns the cheapest route. On small maps the number of labels grows until the cost stops to fall: by
  /// 0.2 % at most where it was measured, in ten times the time.
  planning::Route best(double weight) {
    problem.min_sd = planning::relaxed_sd(problem, kUnlimited);
    planning::Route route = *search({.weight = weight, .labels = 1});
    if (problem.field.cells.count() > kManyLabels) return route;
    for (const int labels : {4, 8}) {
      auto next = search({.weight = weight, .labels = labels, .max_cost = route.cost * (1 + 1e-9)});
      if (!next || !(next->cost < route.cost - 1e-9)) break;
      route = std::move(*next);
    }
    return route;
  }

  /// Routes that weigh the sd, which the search for a limit does not beyond the limit.
  std::vector<planning::Route> weighted() const {
    std::vector<planning::Route> routes;
    for (const double weight : {0.3, 1.0, 3.0, 10.0})
      if (auto route = search({.weight = weight, .labels = 1})) routes.push_back(std::move(*route));
    return routes;
  }

  /// Returns the shortest route found that keeps a limit. The limit of the search is moved until the route
  /// with the belief over worlds just keeps it.
  std::optional<planning::Route> keep(double limit) const {
    const double shortest = problem.to_go[slot(problem.from)];
    const int labels = problem.field.cells.count() <= kManyLabels ? 4 : 1;
    std::optional<planning::Route> kept;
    double low = 0, high = std::numeric_limits<double>::infinity(), asked = limit;
    for (int i = 0; i < kTrials && !(high < 1.02 * low); ++i) {
      auto route = search({.max_sd = asked, .labels = labels});
      // The search is too cautious at most where errors persist; else what it refuses cannot be kept.
      if (!route && i == 0 && (!odometry.drift.any() || min_limit(limit) > limit)) return {};
      const bool keeps = route && route->worst_sd <= limit;
      (route && !keeps ? high : low) = asked;
      if (keeps && (!kept || route->length < kept->length)) kept = std::move(route);
      if (kept && (kept->length < shortest + 1e-6 || kept->worst_sd > kJust * limit)) return kept;
      asked = !(low > 0) ? high / 1.5 : std::isfinite(high) ? std::sqrt(low * high) : 1.5 * low;
    }
    for (planning::Route& route : weighted())
      if (route.worst_sd <= limit && (!kept || route.length < kept->length)) kept = std::move(route);
    return kept;
  }

  /// Returns the route with the smallest worst sd that was found: by bisection of the limit to 1 %, and among
  /// routes that weigh the sd.
  planning::Route min_sd_route() const {
    const planning::Route shortest = *search_white({.labels = 1});
    planning::Route best = with_belief(shortest);
    double low = position_sd(problem.start), high = shortest.worst_sd;
    while (high > 1.01 * low) {
      const double middle = std::sqrt(low * high);
      auto route = search_white({.max_sd = middle, .labels = 1});
      if (!route) {
        low = middle;
        continue;
      }
      high = std::min(middle, route->worst_sd);
      planning::Route known = with_belief(std::move(*route));
      if (known.worst_sd < best.worst_sd) best = std::move(known);
    }
    for (planning::Route& route : weighted())
      if (route.worst_sd < best.worst_sd) best = std::move(route);
    return best;
  }

  /// Returns a lower bound of the limits that a route can keep in any world, to 1 %; `limit` if the relaxed
  /// test does not exclude it. Beliefs over worlds that start apart have no such bound. A refused limit is
  /// asked for twice, so the last answer is kept.
  double min_limit(double limit) const {
    if (!worlds_agree) return limit;
    if (!last_bound || last_bound->first != limit) last_bound = {limit, compute_min_limit(limit)};
    return last_bound->second;
  }
  mutable std::optional<std::pair<double, double>> last_bound = {};  ///< limit of the first leg, its bound

  double compute_min_limit(double limit) const {
    planning::RouteProblem relaxed = problem;
    relaxed.noise = odometry.noise;  // persistent errors may be known: they bound nothing
    std::vector<double> rate = planning::max_rate(relaxed.field);
    const auto excludes = [&](double sd) {
      return !std::isfinite(planning::relaxed_sd(relaxed, sd, rate)[slot(problem.to)]);
    };
    if (!excludes(limit)) return limit;  // the field of the search has less information
    relaxed.field =
        planning::max_information_field(problem.field.cells, problem.passable, landmarks, sensing);
    rate = planning::max_rate(relaxed.field);
    if (!excludes(limit)) return limit;
    double low = limit, high = 2 * limit;
    while (excludes(high)) low = high, high *= 2;
    while (high > 1.01 * low) {
      const double middle = std::sqrt(low * high);
      (excludes(middle) ? low : high) = middle;
    }
    return low;
  }

  [[noreturn]] void fail_impossible(double min_kept) const {
    const planning::Route shortest = *search({.labels = 1});
    throw Error(
        ErrorCode::input,
        fmt::format("no route keeps the sd of the position below {:g} m", request.limit_sigma), request.map,
        fmt::format("no limit below {:.3g} m can be kept, even if every landmark is seen; the shortest route "
                    "keeps {:.3g} m; --least-sigma seeks the least",
                    min_kept, std::ceil(shortest.worst_sd * 1000) / 1000));
  }

  [[noreturn]] void fail_limit(double least_sd) const {
    planning::RouteProblem independent = problem;  // persistent errors can be known: they bound nothing
    independent.noise = odometry.noise;
    const double bound = planning::relaxed_sd(independent, 1e6)[slot(problem.to)];
    throw Error(ErrorCode::input,
                fmt::format("no route keeps the sd of the position below {:g} m", request.limit_sigma),
                request.map,
                fmt::format("the least worst sd that was found is {:.2f} m; at the goal it cannot be below "
                            "{:.2f} m",
                            least_sd, bound));
  }

  planning::Route leg() {
    if (request.keep_landmarks > 0) {
      if (auto route = planning::search_by_landmarks(problem, request.keep_landmarks, request.by_quality))
        return with_belief(*route);
    } else if (request.min_sigma) {
      return min_sd_route();
    } else if (request.limit_sigma > 0) {
      if (auto route = keep(request.limit_sigma)) return *route;
      if (const double min_kept = min_limit(request.limit_sigma); min_kept > request.limit_sigma)
        fail_impossible(min_kept);
      planning::Route safest = min_sd_route();
      if (!(safest.worst_sd <= request.limit_sigma)) fail_limit(safest.worst_sd);
      return safest;
    } else {
      return best(request.weight);
    }
    throw Error(ErrorCode::input, "the search found no route", request.map, "");
  }

  std::vector<std::string> important(const localization::Pose2& pose) const {
    std::vector<std::pair<double, std::string>> found;
    planning::visit_information(
        pose, landmarks, sensing, [&](std::uint32_t i, const planning::Symmetric3& j) {
          if (landmarks[i].quality < sensing.min_confidence) return;
          const auto uid = uids.find(landmarks[i].key);
          found.emplace_back(-(j.xx + j.yy) * landmarks[i].quality, uid == uids.end() ? "" : uid->second);
        });
    std::ranges::sort(found);
    std::vector<std::string> first;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, found.size()); ++i) first.push_back(found[i].second);
    return first;
  }

  PlannedRoute describe(const std::vector<planning::Route>& legs) const {
    PlannedRoute route;
    const planning::RouteCells& cells = problem.field.cells;
    std::vector<planning::RouteNode> nodes;
    planning::Route whole;
    for (const planning::Route& leg : legs) {
      route.length += leg.length, route.outside += leg.outside;
      nodes.insert(nodes.end(), leg.nodes.begin() + (nodes.empty() ? 0 : 1), leg.nodes.end());
    }
    whole.nodes = nodes;
    planning::WorldBeliefs beliefs(problem.start, odometry, landmarks, request.worlds, request.seed);
    std::vector<double> worst = planning::follow_route(beliefs, problem, landmarks, sensing, whole);
    nodes = whole.nodes;
    route.worst_sd = whole.worst_sd;
    double distance = 0;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const planning::RouteNode& node = nodes[k];
      const double x = cells.x(node.cell), y = cells.y(node.cell);
      const double length =
          k ? std::hypot(x - cells.x(nodes[k - 1].cell), y - cells.y(nodes[k - 1].cell)) : 0;
      distance += length;
      const localization::Pose2 pose = planning::heading_pose(x, y, node.heading);
      const planning::Information& seen = problem.field.get(node.cell, node.heading);
      if (seen.landmarks == 0) route.without_landmarks += length;
      route.stations.push_back({map.frame.crs_from_map_frame({{x, y, 0}}).xyz.head<2>(), distance, pose.yaw,
                                node.covariance, position_sd(node.covariance), seen.landmarks,
                                important(pose)});
    }
    route.final_sd = route.stations.back().sd;
    std::ranges::sort(worst, std::greater<>());
    for (const double sd : worst) route.worlds_mean += sd / double(worst.size());
    const std::size_t tenth = std::max<std::size_t>(1, worst.size() / 10);
    for (std::size_t i = 0; i < tenth; ++i) route.worlds_worst_tenth += worst[i] / double(tenth);
    return route;
  }
};

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
  Planner planner{.request = request,
                  .map = map,
                  .landmarks = localization::LandmarkGrid(all_landmarks(map, sensor.get())),
                  .sensing = {.coverage = coverage},
                  .problem = {},
                  .uids = {}};
  for (const Landmark& landmark : map.store->query({}))
    planner.uids[localization::landmark_key(landmark.uid)] = landmark.uid;
  const planning::RouteCells cells = cells_for(points, request.cell, coverage.range);
  planning::RouteProblem& problem = planner.problem;
  problem.passable = passable_cells(cells, classes);
  if (!request.aoi.empty()) close_outside(request.aoi, map, points, cells, problem.passable);
  std::vector<std::int64_t> stops;
  for (const Waypoint& point : points)
    stops.push_back(
        cell_of(point, cells, problem.passable, classes, hazards ? request.hazards : request.aoi));
  planner.sensing.visible = localization::terrain_line_of_sight(open_terrain(map, request.dem),
                                                                {.sensor_height = request.sensor_height});
  problem.field =
      planning::make_information_field(cells, problem.passable, planner.landmarks, planner.sensing);
  double sd = 0.1, yaw_sd = 2 * kRadiansPerDegree;
  planner.odometry = read_odometry(request, map, sd, yaw_sd);
  if (request.start_sd > 0) sd = request.start_sd;
  if (request.limit_sigma > 0 && request.limit_sigma < sd)
    throw Error(
        ErrorCode::usage,
        fmt::format("the sd at the start, {:g} m, exceeds the limit of {:g} m", sd, request.limit_sigma), "",
        "raise --limit-sigma, or give the start's --start-sd");
  problem.noise = planner.odometry.white();
  problem.start = {sd * sd, 0, sd * sd, 0, 0, yaw_sd * yaw_sd};
  const planning::Symmetric3 start = problem.start;

  const auto legs_with = [&](auto&& search) {
    std::vector<planning::Route> legs;
    problem.start = start;
    planner.before.emplace(start, planner.odometry, planner.landmarks, request.worlds, request.seed);
    problem.heading.reset();
    if (points[0].yaw)
      problem.heading = static_cast<int>((std::lround(*points[0].yaw / (std::numbers::pi / 4)) % 8 + 8) % 8);
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      problem.from = stops[i], problem.to = stops[i + 1];
      planner.worlds_agree = i == 0;
      problem.to_go = planning::distances_to(cells, problem.passable, problem.to);
      if (!std::isfinite(problem.to_go[slot(problem.from)])) fail_between(request, points[i], points[i + 1]);
      legs.push_back(search());
      planning::follow_route(*planner.before, problem, planner.landmarks, planner.sensing, legs.back());
      problem.start = legs.back().nodes.back().covariance;
      problem.heading = legs.back().nodes.back().heading;
    }
    problem.start = start;
    return legs;
  };

  RouteResult result;
  result.shortest = planner.describe(legs_with([&] { return *planner.search({.labels = 1}); }));
  result.routes.push_back(planner.describe(legs_with([&] { return planner.leg(); })));
  for (std::int64_t i = 1; i < request.alternatives; ++i) {
    // Along the front of length and worst sd: the next route is a tenth better, as far as one exists.
    const double limit = 0.9 * result.routes.back().worst_sd;
    bool found = true;
    const auto legs = legs_with([&] {
      auto route = planner.keep(limit);
      found = found && route;
      return route ? *route : *planner.search({.labels = 1});
    });
    if (!found) break;
    result.routes.push_back(planner.describe(legs));
  }
  if (request.limit_sigma > 0) {
    // Cells that the relaxed test excludes cannot lie on the route.
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      problem.from = stops[i], problem.to = stops[i + 1];
      std::vector<char> reached = problem.passable;
      if (i == 0) {
        planning::RouteProblem independent = problem;
        independent.noise = planner.odometry.noise;  // persistent errors may be known: they bound nothing
        const std::vector<double> bound = planning::relaxed_sd(independent, request.limit_sigma);
        for (std::size_t k = 0; k < reached.size(); ++k) reached[k] = std::isfinite(bound[k]) ? 1 : 0;
      }
      result.lower_bound += planning::distances_to(cells, reached, problem.to)[slot(problem.from)];
    }
  }
  const std::string clearance = add_clearance(request, map, result);
  write_routes(request, map.crs(), result);
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
  callbacks.summary(text + "\n" + clearance);
  return result;
}

}  // namespace waymark::workflows
