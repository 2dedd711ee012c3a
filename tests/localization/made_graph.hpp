// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numbers>

#include "core/random.hpp"
#include "localization/slam/graph.hpp"
namespace waymark::test {
using namespace localization;

/// A drive of two rounds with landmarks on both sides, all measurements with errors.
struct MadeGraph {
  PoseGraph graph;
  std::vector<Pose2> truth;
  std::vector<Eigen::Vector2d> landmarks;
};

/// Adds walls about the drive, seen from every second pose in two pieces that deviate: directions and
/// distances of correlated noise.
inline void add_walls(MadeGraph& made, std::uint64_t seed) {
  Random random(seed, "walls");
  const auto draw = [&](const Eigen::Matrix2d& root) {
    return Eigen::Vector2d(root.inverse() * Eigen::Vector2d(random.normal(), random.normal()));
  };
  Eigen::Matrix2d noise_root, deviation_root = Eigen::Vector2d(50, 100).asDiagonal();
  noise_root << 40, 12, 0, 80;
  for (int wall = 0; wall < 3; ++wall) {
    const double angle = 2.1 * wall + 0.3;
    SlamLine line{.normal = {std::cos(angle), std::sin(angle)}};
    line.anchor =
        Eigen::Vector2d(0, -10) - 17 * line.normal + 3 * Eigen::Vector2d(random.normal(), random.normal());
    const Eigen::Vector2d state(0.2 * random.normal(), 0.05 * random.normal());
    const std::size_t first = made.graph.deviations.size();
    std::vector<Eigen::Vector2d> deviations;
    for (int piece = 0; piece < 2; ++piece) {
      made.graph.deviations.push_back({.root = deviation_root});
      deviations.push_back(draw(deviation_root));
    }
    for (std::size_t i = 0; i < made.truth.size(); i += 2) {
      SightingEdge e;
      e.pose = i, e.landmark = made.landmarks.size();
      e.kind = SightingKind::line;
      e.root = noise_root;
      e.robot_from_sensor = {0.3, 0.1, 0.2};
      const ExpectedSighting seen = expect(made.truth[i], e.robot_from_sensor, line, state);
      const std::size_t piece = i % 4 / 2;
      e.deviation = first + piece;
      e.by_deviation << 1, random.uniform(-2, 2), 0, 1;
      e.value = seen.value + e.by_deviation * deviations[piece] + draw(noise_root);
      made.graph.sightings.push_back(e);
    }
    made.landmarks.push_back(state);
    made.graph.landmarks.push_back({.id = 2000 + wall, .line = line});
  }
}

inline MadeGraph made_graph(std::uint64_t seed, int poses, SightingKind kind = SightingKind::position,
                            double noise = 1) {
  Random random(seed, "graph");
  MadeGraph made;
  for (int i = 0; i < 8; ++i) {
    const double a = 2 * std::numbers::pi * i / 8, r = i % 2 ? 6.0 : 14.0;
    made.landmarks.emplace_back(r * std::sin(a), r * std::cos(a) - 10);  // about the middle of the rounds
  }
  const double turn = 4 * std::numbers::pi / poses;
  Pose2 at;
  for (int i = 0; i < poses; ++i) {
    made.truth.push_back(at);
    made.graph.poses.push_back({.id = i, .t = double(i), .at = {}});
    if (i > 0) {
      StepEdge e;
      e.from = std::size_t(i) - 1, e.to = std::size_t(i);
      const Pose2 step = inverse(made.truth[e.from]) * at;
      e.step = {step.x + noise * 0.05 * random.normal(), step.y + noise * 0.02 * random.normal(),
                step.yaw + noise * 0.02 * random.normal()};
      e.root = Eigen::Vector3d(1 / 0.05, 1 / 0.02, 1 / 0.02).asDiagonal();
      made.graph.steps.push_back(e);
    }
    for (std::size_t l = 0; l < made.landmarks.size(); ++l) {
      const Pose2 there = inverse(at) * Pose2{made.landmarks[l].x(), made.landmarks[l].y(), 0};
      const double range = there.at().norm();
      if (range > 12) continue;
      SightingEdge e;
      e.pose = std::size_t(i);
      e.landmark = l;
      e.kind = kind;
      if (kind == SightingKind::position) {
        e.value = there.at() + noise * 0.1 * Eigen::Vector2d(random.normal(), random.normal());
        e.root = Eigen::Matrix2d::Identity() * 10;
      } else {
        e.value << range + noise * 0.1 * random.normal(),
            std::atan2(there.y, there.x) + noise * 0.02 * random.normal();
        e.root = Eigen::Vector2d(10, 50).asDiagonal();
      }
      made.graph.sightings.push_back(e);
    }
    at = at * Pose2{10 * turn, 0, -turn};
  }
  for (std::size_t l = 0; l < made.landmarks.size(); ++l)
    made.graph.landmarks.push_back({.id = std::int64_t(1000 + l)});
  return made;
}

inline double distance(const PoseGraph& a, const PoseGraph& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.poses.size(); ++i)
    most = std::max({most, (a.poses[i].at.at() - b.poses[i].at.at()).norm(),
                     std::abs(wrap_angle(a.poses[i].at.yaw - b.poses[i].at.yaw))});
  for (std::size_t i = 0; i < a.landmarks.size(); ++i)
    most = std::max(most, (a.landmarks[i].at - b.landmarks[i].at).norm());
  return most;
}

}  // namespace waymark::test
