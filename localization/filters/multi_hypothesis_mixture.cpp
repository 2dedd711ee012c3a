// SPDX-License-Identifier: Apache-2.0
// Operations of the Gaussian mixture: split, prune and merge, widen, mean.
#include <Eigen/LU>
#include <algorithm>

#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"

namespace waymark::localization {
namespace {

Eigen::Vector3d off(const Pose2& from, const Pose2& to) {
  return {to.x - from.x, to.y - from.y, wrap_angle(to.yaw - from.yaw)};
}

}  // namespace

// Splits a Gaussian that is wide in yaw into five along its principal line of yaw, with the same mean and
// covariance.
void MultiHypothesisFilter::split() {
  std::vector<Component> next;
  constexpr double kSteps[] = {-1.6, -0.8, 0, 0.8, 1.6};
  constexpr double kWeights[] = {0.0924, 0.2414, 0.3324, 0.2414, 0.0924};
  constexpr double kLeft = 0.218;  // fraction of the variance that each keeps
  for (Component& component : components_) {
    const double variance = component.at.covariance(2, 2);
    if (!(variance > options_.split_yaw * options_.split_yaw)) {
      next.push_back(std::move(component));
      continue;
    }
    const Eigen::Vector3d line = component.at.covariance.col(2) / std::sqrt(variance);
    for (int i = 0; i < 5; ++i) {
      Component piece = component;
      piece.at.pose = pose_of(component.at.pose.vector() + kSteps[i] * line);
      piece.at.covariance -= (1 - kLeft) * line * line.transpose();
      piece.weight *= kWeights[i];
      next.push_back(piece);
    }
  }
  components_ = std::move(next);
}

void MultiHypothesisFilter::prune() {
  std::ranges::stable_sort(components_, std::greater<>{}, &Component::weight);
  const double min_weight = components_[0].weight * options_.min_weight;
  std::vector<Component> kept;
  for (Component& component : components_) {
    if (component.weight < min_weight && !kept.empty()) break;
    bool merged = false;
    for (Component& k : kept) {
      if (k.choice != component.choice && !component.choice.empty()) continue;
      const Eigen::Vector3d d = off(k.at.pose, component.at.pose);
      if (std::abs(d.z()) > 1 ||
          d.dot((k.at.covariance + 1e-9 * Eigen::Matrix3d::Identity()).inverse() * d) > options_.merge)
        continue;
      const double a = k.weight / (k.weight + component.weight), b = 1 - a;
      k.at.covariance = a * k.at.covariance + b * component.at.covariance + a * b * d * d.transpose();
      k.at.pose = pose_of(k.at.pose.vector() + b * d);
      k.errors.mix(component.errors, b);
      k.weight += component.weight;
      merged = true;
      break;
    }
    if (!merged && kept.size() < static_cast<std::size_t>(options_.max_hypotheses))
      kept.push_back(std::move(component));
  }
  double total = 0;
  for (const Component& component : kept) total += component.weight;
  for (Component& component : kept) component.weight /= total;
  components_ = std::move(kept);
}

void MultiHypothesisFilter::widen(double factor) {
  for (Component& component : components_) {
    const Eigen::Vector3d sd = component.at.covariance.diagonal().cwiseSqrt() * factor;
    component.at.covariance = clamp_sd(sd).cwiseAbs2().asDiagonal();
    component.errors.clear();
  }
}

PoseEstimate MultiHypothesisFilter::estimate() const {
  const auto best = std::ranges::max_element(components_, {}, &Component::weight);
  const auto moments = [&](double radius) {
    double total = 0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Component& component : components_) {
      const Eigen::Vector3d d = off(best->at.pose, component.at.pose);
      if (d.head<2>().norm() > radius) continue;
      total += component.weight;
      mean += component.weight * d;
    }
    PoseEstimate e{pose_of(best->at.pose.vector() + mean / total), Eigen::Matrix3d::Zero()};
    for (const Component& component : components_) {
      if (off(best->at.pose, component.at.pose).head<2>().norm() > radius) continue;
      const Eigen::Vector3d d = off(e.pose, component.at.pose);
      e.covariance += component.weight / total * (component.at.covariance + d * d.transpose());
    }
    return std::pair(e, total);
  };
  const auto [near, weight] = moments(1);
  return weight > 0.5 ? near : moments(1e12).first;
}

}  // namespace waymark::localization
