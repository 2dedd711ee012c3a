// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/graph.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

#include "localization/filters/measurement.hpp"

namespace waymark::localization {
namespace {

/// Position relative to a pose, and its derivatives with respect to the pose and to the position.
struct Seen {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_position;
};

Seen seen_from(const Pose2& pose, const Eigen::Vector2d& at) {
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  Seen seen;
  seen.by_position << c, s, -s, c;
  seen.value = seen.by_position * (at - pose.at());
  seen.by_pose.leftCols<2>() = -seen.by_position;
  seen.by_pose.col(2) << seen.value.y(), -seen.value.x();
  return seen;
}

template <class Matrix>
Matrix root_of(const Matrix& information) {
  const Eigen::LLT<Matrix> cholesky(information);
  if (!information.allFinite() || cholesky.info() != Eigen::Success ||
      !(information - information.transpose()).isZero(1e-6 * information.norm()))
    throw std::invalid_argument("information matrix is not positive definite");
  return cholesky.matrixU();
}

}  // namespace

StepError step_error(const StepEdge& edge, const Pose2& from, const Pose2& to) {
  const Seen seen = seen_from(from, to.at());
  StepError e;
  e.value << seen.value.x() - edge.step.x, seen.value.y() - edge.step.y,
      wrap_angle(to.yaw - from.yaw - edge.step.yaw);
  e.by_from << seen.by_pose, 0, 0, -1;
  e.by_to << seen.by_position, Eigen::Vector2d::Zero(), 0, 0, 1;
  return {edge.root * e.value, edge.root * e.by_from, edge.root * e.by_to};
}

SightingError sighting_error(const SightingEdge& edge, const Pose2& pose, const Eigen::Vector2d& landmark,
                             const SlamLine* line, const Eigen::Vector2d& deviation) {
  SightingError e;
  if (edge.kind == SightingKind::line) {
    const ExpectedSighting expected = expect(pose, edge.robot_from_sensor, *line, landmark);
    e.value = expected.value - edge.value;
    if (edge.deviation) e.value += edge.by_deviation * deviation;
    e.value[1] = wrap_angle(e.value[1]);
    return {edge.root * e.value, edge.root * expected.by_pose, edge.root * expected.by_landmark,
            edge.root * edge.by_deviation};
  }
  if (edge.kind == SightingKind::position) {
    const Pose2& mount = edge.robot_from_sensor;
    const Seen by_robot = seen_from(pose, landmark), by_sensor = seen_from(mount, by_robot.value);
    e = {by_sensor.value - edge.value, by_sensor.by_position * by_robot.by_pose,
         by_sensor.by_position * by_robot.by_position};
  } else {
    const ExpectedSighting expected = expect(pose, edge.robot_from_sensor, landmark);
    e = {expected.value - edge.value, expected.by_pose, expected.by_landmark};
    e.value[1] = wrap_angle(e.value[1]);
  }
  if (edge.kind == SightingKind::bearing || edge.kind == SightingKind::range) {
    const int measured = edge.kind == SightingKind::range ? 0 : 1, other = 1 - measured;
    e.value[other] = 0;
    e.by_pose.row(other).setZero();
    e.by_landmark.row(other).setZero();
    const double root = edge.root(measured, measured);
    return {root * e.value, root * e.by_pose, root * e.by_landmark};
  }
  return {edge.root * e.value, edge.root * e.by_pose, edge.root * e.by_landmark};
}

SightingError sighting_error(const PoseGraph& graph, const SightingEdge& edge) {
  const GraphLandmark& landmark = graph.landmarks[edge.landmark];
  return sighting_error(
      edge, graph.poses[edge.pose].at, landmark.at, landmark.line ? &*landmark.line : nullptr,
      edge.deviation ? graph.deviations[*edge.deviation].at : Eigen::Vector2d(Eigen::Vector2d::Zero()));
}

Eigen::Vector3d prior_error(const PosePrior& prior, const Pose2& pose) {
  return prior.root *
         Eigen::Vector3d(pose.x - prior.at.x, pose.y - prior.at.y, wrap_angle(pose.yaw - prior.at.yaw));
}

Eigen::Vector2d prior_error(const LandmarkPrior& prior, const Eigen::Vector2d& landmark) {
  return prior.root * (landmark - prior.at);
}

Eigen::Vector2d prior_error(const GraphDeviation& prior, const Eigen::Vector2d& deviation) {
  return prior.root * deviation;
}

double chi2(const PoseGraph& graph) {
  double sum = 0;
  for (const StepEdge& e : graph.steps)
    sum += step_error(e, graph.poses[e.from].at, graph.poses[e.to].at).value.squaredNorm();
  for (const SightingEdge& e : graph.sightings) sum += sighting_error(graph, e).value.squaredNorm();
  for (const PosePrior& p : graph.pose_priors) sum += prior_error(p, graph.poses[p.pose].at).squaredNorm();
  for (const LandmarkPrior& p : graph.landmark_priors)
    sum += prior_error(p, graph.landmarks[p.landmark].at).squaredNorm();
  for (const GraphDeviation& d : graph.deviations) sum += prior_error(d, d.at).squaredNorm();
  return sum;
}

Eigen::Matrix3d information_root(const Eigen::Matrix3d& information) {
  return root_of(information);
}
Eigen::Matrix2d information_root(const Eigen::Matrix2d& information) {
  return root_of(information);
}

std::size_t residual_count(const PoseGraph& graph) {
  std::size_t count = 3 * (graph.steps.size() + graph.pose_priors.size()) +
                      2 * (graph.landmark_priors.size() + graph.deviations.size());
  for (const SightingEdge& e : graph.sightings)
    count += e.kind == SightingKind::bearing || e.kind == SightingKind::range ? 1 : 2;
  return count;
}

bool has_gauge(const PoseGraph& graph) {
  return !graph.pose_priors.empty() || graph.landmark_priors.size() >= 2 ||
         std::ranges::count(graph.poses, true, &GraphPose::fixed) > 0;
}

std::size_t unknown_count(const PoseGraph& graph) {
  const auto fixed = has_gauge(graph) ? std::ranges::count(graph.poses, true, &GraphPose::fixed) : 1;
  return 3 * (graph.poses.size() - static_cast<std::size_t>(fixed)) +
         2 * (graph.landmarks.size() + graph.deviations.size());
}

}  // namespace waymark::localization
