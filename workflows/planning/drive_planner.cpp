// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/drive_planner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planning/landmark_watch.hpp"

namespace waymark::workflows {
namespace {

/// Closes the cells near obstacles.
void block(std::vector<char>& passable, const planning::RouteCells& cells,
           std::span<const planning::SeenObstacle> obstacles, double clearance) {
  for (const planning::SeenObstacle& o : obstacles) {
    const double reach = o.radius + clearance + cells.cell / 4;
    for (std::int64_t i = 0; i < cells.count(); ++i)
      if (std::hypot(cells.x(i) - o.at.x(), cells.y(i) - o.at.y()) < reach)
        passable[static_cast<std::size_t>(i)] = 0;
  }
}

/// Returns the passable cell nearest to a position, within three cells; -1 if there is none.
std::int64_t nearest_passable(const planning::RouteCells& cells, const std::vector<char>& passable,
                              const Eigen::Vector2d& at) {
  std::int64_t best = -1;
  double min_distance = 3 * cells.cell;
  for (std::int64_t i = 0; i < cells.count(); ++i) {
    const double d = std::hypot(cells.x(i) - at.x(), cells.y(i) - at.y());
    if (passable[static_cast<std::size_t>(i)] && d < min_distance) min_distance = d, best = i;
  }
  return best;
}

/// Returns the covariance, made positive definite: particles may agree on one heading.
planning::Symmetric3 belief_of(const localization::PoseEstimate& pose) {
  return planning::symmetric(pose.covariance + 1e-6 * Eigen::Matrix3d::Identity());
}

}  // namespace

DrivePlanner::DrivePlanner(localization::LandmarkGrid landmarks, Settings settings,
                           std::shared_ptr<const HazardClasses> hazards)
    : landmarks_(std::move(landmarks)),
      settings_(std::move(settings)),
      sensing_{.coverage = settings_.coverage, .visible = settings_.visible},
      hazards_(std::move(hazards)) {}

std::optional<DrivePlan> DrivePlanner::plan(const DrivePlanRequest& request) const {
  const planning::RouteCells cells = cells_for({Waypoint{request.from.pose.at()}, Waypoint{request.to}},
                                               settings_.cell, settings_.coverage.range);
  planning::RouteProblem problem;
  problem.noise = settings_.noise;
  problem.passable = passable_cells(cells, hazards_.get());
  block(problem.passable, cells, request.obstacles, settings_.clearance);
  problem.from = nearest_passable(cells, problem.passable, request.from.pose.at());
  problem.to = nearest_passable(cells, problem.passable, request.to);
  if (problem.from < 0 || problem.to < 0) return {};
  const localization::LandmarkGrid there = planning::map_without(landmarks_, request.gone);
  problem.field = planning::make_information_field(cells, problem.passable, there, sensing_);
  problem.start = belief_of(request.from);
  problem.heading =
      static_cast<int>((std::lround(request.from.pose.yaw / (std::numbers::pi / 4)) % 8 + 8) % 8);
  std::optional<planning::Route> route;
  DrivePlan plan;
  const double limit = settings_.limit_sigma;
  if (limit > 0) route = planning::search_by_sigma(problem, {.max_sd = limit});
  plan.keeps_limit = route.has_value() || !(limit > 0);
  if (!route)
    route = planning::search_by_sigma(problem,
                                      {.weight = limit > 0 ? 1 / limit : 0, .labels = limit > 0 ? 4 : 1});
  if (!route) return {};
  plan.length = route->length, plan.worst_sd = route->worst_sd;
  plan.points.push_back({request.from.pose.at(), planning::position_sd(problem.start)});
  for (const planning::RouteNode& node : route->nodes)
    plan.points.push_back({{cells.x(node.cell), cells.y(node.cell)}, planning::position_sd(node.covariance)});
  if (plan.points.size() > 2) plan.points.erase(plan.points.begin() + 1);  // the cell of the vehicle itself
  plan.points.back().at = request.to;
  return plan;
}

double DrivePlanner::expected_sd(const localization::PoseEstimate& from,
                                 std::span<const Eigen::Vector2d> path,
                                 std::span<const localization::LandmarkKey> gone) const {
  const localization::LandmarkGrid there = planning::map_without(landmarks_, gone);
  planning::Symmetric3 p = belief_of(from);
  double worst = planning::position_sd(p), yaw = from.pose.yaw;
  Eigen::Vector2d at = from.pose.at();
  for (const Eigen::Vector2d& next : path) {
    const double length = (next - at).norm();
    if (!(length >= settings_.cell)) continue;  // steps of a cell, as the plan has them
    const Eigen::Vector2d along = (next - at) / length;
    const double heading = std::atan2(along.y(), along.x());
    p = planning::predict(p,
                          {length, along.x(), along.y(), std::abs(localization::wrap_angle(heading - yaw))},
                          settings_.noise);
    planning::Symmetric3 j = planning::information_at({next.x(), next.y(), heading}, there, sensing_).rate;
    for (double* value : {&j.xx, &j.xy, &j.yy, &j.xt, &j.yt, &j.tt}) *value *= length;
    p = planning::update(p, j);
    worst = std::max(worst, planning::position_sd(p));
    at = next, yaw = heading;
  }
  return worst;
}

}  // namespace waymark::workflows
