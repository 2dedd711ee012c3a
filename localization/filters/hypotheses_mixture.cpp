// SPDX-License-Identifier: Apache-2.0
// What a sum of Gaussians does by itself: it splits, merges, widens and has a mean.
#include <Eigen/LU>
#include <algorithm>

#include "localization/filters/hypotheses.hpp"
#include "localization/filters/kalman.hpp"

namespace waymark {
namespace {

Eigen::Vector3d off(const Pose2& from, const Pose2& to) {
  return {to.x - from.x, to.y - from.y, wrapped(to.yaw - from.yaw)};
}

}  // namespace

// A Gaussian wide in yaw becomes five along its main line of yaw, with the same mean and covariance.
void HypothesesFilter::split() {
  std::vector<Part> next;
  constexpr double kSteps[] = {-1.6, -0.8, 0, 0.8, 1.6};
  constexpr double kWeights[] = {0.0924, 0.2414, 0.3324, 0.2414, 0.0924};
  constexpr double kLeft = 0.218;  // variance that each keeps
  for (const Part& part : parts_) {
    const double variance = part.at.covariance(2, 2);
    if (!(variance > options_.split_yaw * options_.split_yaw)) {
      next.push_back(part);
      continue;
    }
    const Eigen::Vector3d line = part.at.covariance.col(2) / std::sqrt(variance);
    for (int i = 0; i < 5; ++i) {
      Part piece = part;
      piece.at.pose = pose_of(part.at.pose.vector() + kSteps[i] * line);
      piece.at.covariance -= (1 - kLeft) * line * line.transpose();
      piece.weight *= kWeights[i];
      next.push_back(piece);
    }
  }
  parts_ = std::move(next);
}

void HypothesesFilter::prune() {
  std::ranges::stable_sort(parts_, std::greater<>{}, &Part::weight);
  const double least = parts_[0].weight * options_.least;
  std::vector<Part> kept;
  for (const Part& part : parts_) {
    if (part.weight < least && !kept.empty()) break;
    bool merged = false;
    for (Part& k : kept) {
      if (k.choice != part.choice && !part.choice.empty()) continue;
      const Eigen::Vector3d d = off(k.at.pose, part.at.pose);
      if (std::abs(d.z()) > 1 ||
          d.dot((k.at.covariance + 1e-9 * Eigen::Matrix3d::Identity()).inverse() * d) > options_.merge)
        continue;
      const double a = k.weight / (k.weight + part.weight), b = 1 - a;
      k.at.covariance = a * k.at.covariance + b * part.at.covariance + a * b * d * d.transpose();
      k.at.pose = pose_of(k.at.pose.vector() + b * d);
      k.weight += part.weight;
      merged = true;
      break;
    }
    if (!merged && kept.size() < static_cast<std::size_t>(options_.most)) kept.push_back(part);
  }
  double total = 0;
  for (const Part& part : kept) total += part.weight;
  for (Part& part : kept) part.weight /= total;
  parts_ = std::move(kept);
}

void HypothesesFilter::widen(double factor) {
  for (Part& part : parts_) {
    const Eigen::Vector3d sd = part.at.covariance.diagonal().cwiseSqrt() * factor;
    part.at.covariance = widest(sd).cwiseAbs2().asDiagonal();
  }
}

PoseEstimate HypothesesFilter::estimate() const {
  const auto best = std::ranges::max_element(parts_, {}, &Part::weight);
  const auto moments = [&](double radius) {
    double total = 0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Part& part : parts_) {
      const Eigen::Vector3d d = off(best->at.pose, part.at.pose);
      if (d.head<2>().norm() > radius) continue;
      total += part.weight;
      mean += part.weight * d;
    }
    PoseEstimate e{pose_of(best->at.pose.vector() + mean / total), Eigen::Matrix3d::Zero()};
    for (const Part& part : parts_) {
      if (off(best->at.pose, part.at.pose).head<2>().norm() > radius) continue;
      const Eigen::Vector3d d = off(e.pose, part.at.pose);
      e.covariance += part.weight / total * (part.at.covariance + d * d.transpose());
    }
    return std::pair(e, total);
  };
  const auto [near, weight] = moments(1);
  return weight > 0.5 ? near : moments(1e12).first;
}

}  // namespace waymark
