// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/resampling.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "localization/body_motion.hpp"

namespace waymark {
namespace {

constexpr double kEverywhere = 1e150;  // m

PoseEstimate moments(std::span<const Pose2> poses, std::span<const double> weights,
                     const Eigen::Vector2d& near, double radius) {
  double total = 0, c = 0, s = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  const auto inside = [&](const Pose2& p) { return (p.at() - near).squaredNorm() <= radius * radius; };
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!inside(poses[i])) continue;
    total += weights[i];
    mean += weights[i] * (poses[i].at() - near);  // about a near point: no cancellation far from the origin
    c += weights[i] * std::cos(poses[i].yaw);
    s += weights[i] * std::sin(poses[i].yaw);
  }
  if (!(total > 0)) return {{near.x(), near.y(), 0}, Eigen::Matrix3d::Zero()};
  const Eigen::Vector2d at = near + mean / total;
  PoseEstimate e{{at.x(), at.y(), std::atan2(s, c)}, Eigen::Matrix3d::Zero()};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!inside(poses[i])) continue;
    const Eigen::Vector3d d(poses[i].x - at.x(), poses[i].y - at.y(), wrapped(poses[i].yaw - e.pose.yaw));
    e.covariance += weights[i] / total * d * d.transpose();
  }
  return e;
}

}  // namespace

double effective_count(std::span<const double> weights) {
  double squares = 0;
  for (const double w : weights) squares += w * w;
  return squares > 0 ? 1 / squares : 0;
}

std::vector<std::uint32_t> resample(std::span<const double> weights, std::size_t count, double u) {
  std::vector<std::uint32_t> drawn;
  if (weights.empty()) return drawn;
  drawn.reserve(count);
  double sum = weights[0];
  std::uint32_t i = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = (static_cast<double>(k) + u) / static_cast<double>(count);
    while (sum < at && i + 1 < weights.size()) sum += weights[++i];
    drawn.push_back(i);
  }
  return drawn;
}

PoseEstimate moments(std::span<const Pose2> poses, std::span<const double> weights) {
  return moments(poses, weights, poses.empty() ? Eigen::Vector2d(0, 0) : poses[0].at(), kEverywhere);
}

std::vector<Pose2> redraw(std::span<const Pose2> poses, std::span<const double> weights, std::size_t count,
                          Random& random) {
  const PoseEstimate all = moments(poses, weights);
  const double blur = std::pow(0.8 / static_cast<double>(std::max<std::size_t>(count, 2)), 2.0 / 7);
  const Eigen::Matrix3d root = square_root(blur * all.covariance);
  std::vector<Pose2> next;
  next.reserve(count);
  for (const std::uint32_t i : resample(weights, count, random.uniform())) {
    const Pose2& p = poses[i];
    const Eigen::Vector3d off(p.x - all.pose.x, p.y - all.pose.y, wrapped(p.yaw - all.pose.yaw));
    const Eigen::Vector3d noise(random.normal(), random.normal(), random.normal());
    next.push_back(pose_of(all.pose.vector() + std::sqrt(1 - blur) * off + root * noise));
  }
  return next;
}

double bearable_part(std::span<const double> weights, std::span<const double> fit, double most,
                     double least) {
  const double best = fit.empty() ? 0 : std::ranges::max(fit);
  const auto bearable = [&](double part) {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double w = weights[i] * std::exp(part * (fit[i] - best));
      sum += w, squares += w * w;
    }
    return sum * sum >= least * squares;
  };
  if (bearable(most)) return most;
  double low = 0, high = most;
  for (int i = 0; i < 10; ++i) {
    const double middle = (low + high) / 2;
    (bearable(middle) ? low : high) = middle;
  }
  return low;
}

std::size_t kld_count(std::size_t bins, double error) {
  if (bins < 2) return 1;
  constexpr double kNormal99 = 2.3263478740408408;
  const double k = static_cast<double>(bins - 1), a = 2 / (9 * k);
  const double root = 1 - a + std::sqrt(a) * kNormal99;
  return static_cast<std::size_t>(std::ceil(k / (2 * error) * root * root * root));
}

std::size_t occupied_bins(std::span<const Pose2> poses, double metres, double radians) {
  std::vector<std::tuple<double, double, double>> bins;
  bins.reserve(poses.size());
  for (const Pose2& p : poses)
    bins.emplace_back(std::floor(p.x / metres), std::floor(p.y / metres),
                      std::floor(wrapped(p.yaw) / radians));
  std::ranges::sort(bins);
  return static_cast<std::size_t>(std::ranges::unique(bins).begin() - bins.begin());
}

PoseEstimate summary(std::span<const Pose2> poses, std::span<const double> weights, double radius) {
  const PoseEstimate all = moments(poses, weights);
  if (std::sqrt(all.covariance(0, 0) + all.covariance(1, 1)) < radius / 3) return all;
  // The heaviest cell, then its surroundings.
  std::vector<std::tuple<double, double, std::size_t>> cells;
  for (std::size_t i = 0; i < poses.size(); ++i)
    cells.emplace_back(std::floor(poses[i].x / radius), std::floor(poses[i].y / radius), i);
  std::ranges::sort(cells);
  double heaviest = -1, weight = 0;
  std::size_t best = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool same = i && std::get<0>(cells[i]) == std::get<0>(cells[i - 1]) &&
                      std::get<1>(cells[i]) == std::get<1>(cells[i - 1]);
    weight = (same ? weight : 0) + weights[std::get<2>(cells[i])];
    if (weight > heaviest) heaviest = weight, best = std::get<2>(cells[i]);
  }
  Eigen::Vector2d centre = poses[best].at();
  for (int i = 0; i < 3; ++i) centre = moments(poses, weights, centre, radius).pose.at();
  double inside = 0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if ((poses[i].at() - centre).norm() <= radius) inside += weights[i];
  return inside > 0.5 ? moments(poses, weights, centre, radius) : all;
}

}  // namespace waymark
