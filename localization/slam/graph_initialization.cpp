// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/graph_initialization.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <queue>
#include <stdexcept>

#include "core/error.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

void check_indices(const PoseGraph& graph) {
  const std::size_t poses = graph.poses.size(), landmarks = graph.landmarks.size();
  bool sound = true;
  for (const StepEdge& e : graph.steps)
    sound &= e.from < poses && e.to < poses && e.from != e.to && e.step.finite() && e.root.allFinite();
  for (const SightingEdge& e : graph.sightings)
    sound &= e.pose < poses && e.landmark < landmarks && e.value.allFinite() && e.root.allFinite() &&
             (e.kind == SightingKind::line) == graph.landmarks[e.landmark].line.has_value() &&
             (!e.deviation || (*e.deviation < graph.deviations.size() && e.kind == SightingKind::line));
  for (const PosePrior& p : graph.pose_priors) sound &= p.pose < poses && p.at.finite() && p.root.allFinite();
  for (const LandmarkPrior& p : graph.landmark_priors)
    sound &= p.landmark < landmarks && p.at.allFinite() && p.root.allFinite();
  if (!sound) throw std::out_of_range("an edge of the graph has an invalid index or is not finite");
}

/// Edges by the poses and landmarks they connect.
struct Neighbours {
  explicit Neighbours(const PoseGraph& graph)
      : steps(graph.poses.size()), sightings(graph.poses.size()), seen_from(graph.landmarks.size()) {
    for (std::size_t i = 0; i < graph.steps.size(); ++i) {
      steps[graph.steps[i].from].push_back(i);
      steps[graph.steps[i].to].push_back(i);
    }
    for (std::size_t i = 0; i < graph.sightings.size(); ++i) {
      sightings[graph.sightings[i].pose].push_back(i);
      seen_from[graph.sightings[i].landmark].push_back(graph.sightings[i].pose);
    }
  }
  std::vector<std::vector<std::size_t>> steps, sightings, seen_from;
};

}  // namespace

std::optional<Eigen::Vector2d> landmark_position(const SightingEdge& edge, const Pose2& pose) {
  if (edge.kind != SightingKind::position && edge.kind != SightingKind::range_bearing) return {};
  const Pose2 sensor = pose * edge.robot_from_sensor;
  const Eigen::Vector2d there =
      edge.kind == SightingKind::position
          ? edge.value
          : Eigen::Vector2d(edge.value[0] *
                            Eigen::Vector2d(std::cos(edge.value[1]), std::sin(edge.value[1])));
  return (sensor * Pose2{there.x(), there.y(), 0}).at();
}

Eigen::Vector2d line_state(const SightingEdge& edge, const Pose2& pose, const SlamLine& line) {
  const Pose2 sensor = pose * edge.robot_from_sensor;
  const double angle = sensor.yaw + edge.value[1];
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
  return {normal.dot(sensor.at() - line.anchor) - edge.value[0],
          wrap_angle(angle - std::atan2(line.normal.y(), line.normal.x()))};
}

std::vector<InitializationStep> initialization_order(const PoseGraph& graph) {
  if (graph.poses.empty()) throw Error(ErrorCode::input, "the graph has no poses");
  check_indices(graph);
  const Neighbours near(graph);
  std::vector<InitializationStep> order;
  std::vector<bool> placed(graph.poses.size(), false), known(graph.landmarks.size(), false);
  std::vector<std::size_t> shared(graph.poses.size(), 0);  // known landmarks seen from each pose
  for (const LandmarkPrior& p : graph.landmark_priors) known[p.landmark] = true;
  std::priority_queue<std::size_t, std::vector<std::size_t>, std::greater<>> by_step, by_landmarks;
  std::vector<std::size_t> order_index(graph.poses.size(), kNone);
  const auto place = [&](std::size_t pose) {
    placed[pose] = true;
    // Prefers the step from the pose before: that is odometry, loops come later.
    std::optional<std::size_t> best;
    std::size_t nearest = kNone;
    for (const std::size_t i : near.steps[pose]) {
      const std::size_t other = graph.steps[i].from == pose ? graph.steps[i].to : graph.steps[i].from;
      if (!placed[other] || other == pose) {
        by_step.push(other);
        continue;
      }
      const std::size_t away = other < pose ? pose - other : other - pose;
      if (away < nearest) nearest = away, best = i;
    }
    order.push_back({pose, order.empty() ? std::nullopt : best});
    for (const std::size_t i : near.sightings[pose]) {
      const std::size_t landmark = graph.sightings[i].landmark;
      if (known[landmark]) continue;
      known[landmark] = true;
      for (const std::size_t other : near.seen_from[landmark])
        if (++shared[other] >= 2) by_landmarks.push(other);
    }
  };
  place(0);
  while (order.size() < graph.poses.size()) {
    auto& next = by_step.empty() ? by_landmarks : by_step;
    if (next.empty()) break;
    const std::size_t pose = next.top();
    next.pop();
    if (!placed[pose]) place(pose);
  }
  if (const auto lost = std::ranges::find(placed, false); lost != placed.end()) {
    const auto count = std::ranges::count(placed, false);
    throw Error(ErrorCode::input,
                fmt::format("the graph is not connected: pose {} has no path to pose {}, nor have {} more",
                            graph.poses[static_cast<std::size_t>(lost - placed.begin())].id,
                            graph.poses[0].id, count - 1),
                "", "add the missing odometry edge, or two landmarks that both parts see");
  }
  if (const auto lost = std::ranges::find(known, false); lost != known.end())
    throw Error(ErrorCode::input,
                fmt::format("landmark {} of the graph has no sighting",
                            graph.landmarks[static_cast<std::size_t>(lost - known.begin())].id),
                "", "remove it, or add its sightings");
  return order;
}

void check_connected(const PoseGraph& graph) {
  initialization_order(graph);
}

std::optional<Pose2> resect_pose(const PoseGraph& graph, const std::vector<std::size_t>& sightings,
                                 const std::vector<bool>& placed) {
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pairs;  // in the robot, in the map
  Eigen::Vector2d middle_a = Eigen::Vector2d::Zero(), middle_b = middle_a;
  for (const std::size_t i : sightings) {
    const SightingEdge& e = graph.sightings[i];
    const auto in_robot = landmark_position(e, {});
    if (!placed[e.landmark] || !in_robot) continue;
    pairs.emplace_back(*in_robot, graph.landmarks[e.landmark].at);
    middle_a += pairs.back().first;
    middle_b += pairs.back().second;
  }
  if (pairs.size() < 2) return {};
  middle_a /= static_cast<double>(pairs.size());
  middle_b /= static_cast<double>(pairs.size());
  double dot = 0, cross = 0;
  for (const auto& [a, b] : pairs) {
    const Eigen::Vector2d from = a - middle_a, to = b - middle_b;
    dot += from.dot(to);
    cross += from.x() * to.y() - from.y() * to.x();
  }
  const Pose2 turn{0, 0, std::atan2(cross, dot)};
  const Eigen::Vector2d at = middle_b - (turn * Pose2{middle_a.x(), middle_a.y(), 0}).at();
  return Pose2{at.x(), at.y(), turn.yaw};
}

std::optional<Eigen::Vector2d> intersect_rays(const Pose2& a, const Pose2& b) {
  constexpr double kMinSine = 0.1;
  const double sine = std::sin(b.yaw - a.yaw);
  if (std::abs(sine) < kMinSine) return {};
  const Eigen::Vector2d between = b.at() - a.at(), along(std::cos(a.yaw), std::sin(a.yaw));
  const double far = (between.x() * std::sin(b.yaw) - between.y() * std::cos(b.yaw)) / sine;
  if (!(far > 0)) return {};
  return a.at() + far * along;
}

}  // namespace waymark::localization
