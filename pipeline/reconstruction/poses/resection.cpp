// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/poses/resection.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "core/random.hpp"
#include "core/solve.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::size_t kMinAgreeing = 6;
constexpr double kMinDepth = 0.1;  // of a ray of length 1, for samples

std::optional<Eigen::Vector2d> miss(const Camera& camera, const Eigen::Isometry3d& camera_from_world,
                                    const ImagedPoint& point) {
  const auto seen = project(camera, Point<CameraFrame>{camera_from_world * point.position});
  return seen ? std::optional(Eigen::Vector2d(*seen - point.pixel)) : std::nullopt;
}

struct Agreement {
  double score = 0;
  std::vector<std::size_t> inliers = {};
};

Agreement agreement(const Camera& camera, const Eigen::Isometry3d& camera_from_world,
                    std::span<const ImagedPoint> points, double threshold) {
  Agreement out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto d = miss(camera, camera_from_world, points[i]);
    if (!d || !(d->norm() < threshold)) continue;
    out.score += 1 - d->squaredNorm() / (threshold * threshold);
    out.inliers.push_back(i);
  }
  return out;
}

std::vector<Eigen::Isometry3d> three_point_poses(const std::array<Eigen::Vector3d, 3>& positions,
                                                 const std::array<Eigen::Vector3d, 3>& rays) {
  std::vector<cv::Point3d> objects;
  std::vector<cv::Point2d> images;
  for (std::size_t k = 0; k < 3; ++k) {
    objects.emplace_back(positions[k].x(), positions[k].y(), positions[k].z());
    images.emplace_back(rays[k].x() / rays[k].z(), rays[k].y() / rays[k].z());
  }
  std::vector<cv::Mat> rotations, shifts;
  std::vector<Eigen::Isometry3d> poses;
  try {
    cv::solveP3P(objects, images, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations, shifts,
                 cv::SOLVEPNP_AP3P);
  } catch (const cv::Exception&) {
    return poses;
  }
  for (std::size_t k = 0; k < rotations.size(); ++k) {
    const Eigen::Vector3d w(rotations[k].at<double>(0), rotations[k].at<double>(1),
                            rotations[k].at<double>(2));
    const Eigen::Vector3d t(shifts[k].at<double>(0), shifts[k].at<double>(1), shifts[k].at<double>(2));
    if (!w.allFinite() || !t.allFinite()) continue;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = rotation_by(w);
    pose.translation() = t;
    poses.push_back(pose);
  }
  return poses;
}

Eigen::Isometry3d nudged(const Eigen::Isometry3d& pose, const Eigen::Matrix<double, 6, 1>& step) {
  Eigen::Isometry3d out = pose;
  out.linear() = rotation_by(step.head<3>()) * pose.linear();
  out.translation() += step.tail<3>();
  return out;
}

// Gauss-Newton with numeric derivatives, Cauchy weights; camera_from_world.
Eigen::Isometry3d refine_resection(const Camera& camera, Eigen::Isometry3d pose,
                                   std::span<const ImagedPoint> points, double threshold) {
  Agreement best = agreement(camera, pose, points, threshold);
  for (int round = 0; round < 8; ++round) {
    const double depth = std::max(1e-9, pose.translation().norm() + 1e-6);
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (const std::size_t i : best.inliers) {
      const auto r = miss(camera, pose, points[i]);
      Eigen::Matrix<double, 2, 6> slope;
      bool complete = r.has_value();
      for (int k = 0; k < 6 && complete; ++k) {
        const double h = k < 3 ? 1e-6 : 1e-6 * depth;
        const auto there = miss(camera, nudged(pose, h * Eigen::Matrix<double, 6, 1>::Unit(k)), points[i]);
        complete = there.has_value();
        if (complete) slope.col(k) = (*there - *r) / h;
      }
      if (!complete) continue;
      const double weight = 1 / (1 + r->squaredNorm() * 4 / (threshold * threshold));
      normal += weight * slope.transpose() * slope;
      right -= weight * slope.transpose() * *r;
    }
    const Eigen::Matrix<double, 6, 1> step = solve_symmetric(normal, right);
    if (!step.allFinite()) break;
    const Eigen::Isometry3d next = nudged(pose, step);
    Agreement there = agreement(camera, next, points, threshold);
    if (!(there.score > best.score * (1 + 1e-9))) break;
    pose = next;
    best = std::move(there);
  }
  return pose;
}

}  // namespace

std::optional<Resection> resect(const Camera& camera, std::span<const ImagedPoint> points,
                                const ResectionSettings& settings) {
  std::vector<std::size_t> usable;
  std::vector<Eigen::Vector3d> rays(points.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto along = ray(camera, points[i].pixel);
    if (!along || !(along->unit.z() > kMinDepth)) continue;
    rays[i] = along->unit;
    usable.push_back(i);
  }
  if (usable.size() < kMinAgreeing) return std::nullopt;
  Random random(settings.seed);
  Eigen::Isometry3d best = Eigen::Isometry3d::Identity();
  Agreement widest;
  double needed = settings.max_samples;
  for (int sample = 0; sample < std::min(double(settings.max_samples), needed); ++sample) {
    std::array<std::size_t, 3> at{};
    for (std::size_t& i : at) i = usable[random.uniform_index(usable.size())];
    if (at[0] == at[1] || at[0] == at[2] || at[1] == at[2]) continue;
    for (const Eigen::Isometry3d& pose :
         three_point_poses({points[at[0]].position, points[at[1]].position, points[at[2]].position},
                           {rays[at[0]], rays[at[1]], rays[at[2]]})) {
      Agreement there = agreement(camera, pose, points, settings.threshold);
      if (!(there.score > widest.score)) continue;
      widest = std::move(there);
      best = pose;
      const double fraction = double(widest.inliers.size()) / double(usable.size());
      needed = std::max(30.0, std::log(1e-4) / std::log(std::max(1e-12, 1 - std::pow(fraction, 3))));
    }
  }
  if (widest.inliers.size() < kMinAgreeing) return std::nullopt;
  best = refine_resection(camera, best, points, settings.threshold);
  return Resection{best.inverse(), agreement(camera, best, points, settings.threshold).inliers};
}

}  // namespace waymark::pipeline
