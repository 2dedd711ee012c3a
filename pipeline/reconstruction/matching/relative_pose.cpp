// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/relative_pose.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/solve.hpp"

namespace waymark::pipeline {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& t) {
  Eigen::Matrix3d m;
  m << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  return m;
}

// Sampson's approximation of the angle between the rays and the nearest pair of rays that meet.
double epipolar_angle(const Eigen::Matrix3d& essential, const RayPair& rays) {
  const Eigen::Vector3d line = essential * rays.first, back = essential.transpose() * rays.second;
  const double miss = rays.second.dot(line);
  const double slope = line.squaredNorm() + back.squaredNorm() - 2 * miss * miss;
  return slope > 0 ? miss / std::sqrt(slope) : 0;
}

// Points nearer to infinity than the threshold resolves count as before both cameras.
bool is_before_both(const RelativePose& pose, const RayPair& rays, double threshold) {
  const Eigen::Vector3d a = pose.rotation * rays.first;
  const double c = a.dot(rays.second), resolved = 1 - c * c;
  if (resolved < 4 * threshold * threshold) return c > 0;
  const double ta = pose.direction.dot(a), tb = pose.direction.dot(rays.second);
  return tb * c - ta > 0 && tb - c * ta > 0;
}

RelativePose moved(const RelativePose& pose, const Eigen::Matrix<double, 5, 1>& step) {
  const Eigen::Vector3d u = pose.direction.unitOrthogonal(), v = pose.direction.cross(u);
  return {rotation_by(step.head<3>()) * pose.rotation,
          (pose.direction + step[3] * u + step[4] * v).normalized()};
}

}  // namespace

PoseScore score_pose(const RelativePose& pose, std::span<const RayPair> pairs, double threshold) {
  const Eigen::Matrix3d essential = cross_matrix(pose.direction) * pose.rotation;
  PoseScore out;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double angle = epipolar_angle(essential, pairs[i]) / threshold;
    if (!(std::abs(angle) < 1) || !is_before_both(pose, pairs[i], threshold)) continue;
    out.score += 1 - angle * angle;
    out.inliers.push_back(i);
  }
  return out;
}

RelativePose refine_pose(RelativePose pose, std::span<const RayPair> pairs, double threshold) {
  constexpr double kStep = 1e-6;
  PoseScore best = score_pose(pose, pairs, threshold);
  for (int round = 0; round < 10 && best.inliers.size() >= 6; ++round) {
    std::array<Eigen::Matrix3d, 5> essentials;
    for (int k = 0; k < 5; ++k) {
      const RelativePose there = moved(pose, kStep * Eigen::Matrix<double, 5, 1>::Unit(k));
      essentials[static_cast<std::size_t>(k)] = cross_matrix(there.direction) * there.rotation;
    }
    const Eigen::Matrix3d essential = cross_matrix(pose.direction) * pose.rotation;
    Eigen::Matrix<double, 5, 5> normal = 1e-12 * Eigen::Matrix<double, 5, 5>::Identity();
    Eigen::Matrix<double, 5, 1> right = Eigen::Matrix<double, 5, 1>::Zero();
    for (const std::size_t i : best.inliers) {
      const double r = epipolar_angle(essential, pairs[i]);
      Eigen::Matrix<double, 5, 1> slope;
      for (int k = 0; k < 5; ++k)
        slope[k] = (epipolar_angle(essentials[static_cast<std::size_t>(k)], pairs[i]) - r) / kStep;
      const double weight = 1 / (1 + 4 * r * r / (threshold * threshold));
      normal += weight * slope * slope.transpose();
      right -= weight * r * slope;
    }
    const RelativePose next = moved(pose, normal.ldlt().solve(right));
    PoseScore there = score_pose(next, pairs, threshold);
    if (!(there.score > best.score)) break;
    const bool done = there.score < best.score * (1 + 1e-6);
    pose = next;
    best = std::move(there);
    if (done) break;
  }
  return pose;
}

FittedRotation fit_rotation(std::span<const RayPair> pairs, double threshold, Eigen::Matrix3d rotation) {
  std::size_t count = 0;
  for (int round = 0; round < 15; ++round) {
    const double width = threshold * std::pow(2.0, std::max(0, 6 - round));
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    count = 0;
    for (const RayPair& rays : pairs) {
      const double angle = (rotation * rays.first - rays.second).norm();
      if (angle < threshold) ++count;
      if (angle < 3 * width)
        sum += rays.second * rays.first.transpose() / (1 + angle * angle / (width * width));
    }
    if (round == 14 || sum.isZero()) break;
    const SingularValues3 svd = singular_values(sum);
    Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
    flip(2, 2) = (svd.u * svd.v.transpose()).determinant();
    rotation = svd.u * flip * svd.v.transpose();
  }
  return {rotation, count};
}

}  // namespace waymark::pipeline
