// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/resampling.hpp"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <tuple>

#include "core/ziggurat.hpp"
#include "localization/body_motion.hpp"

namespace waymark::localization {
namespace {

constexpr double kEverywhere = 1e150;  // m

/// Direction of the sum of the unit vectors within a squared distance.
double direction(std::span<const Pose2> poses, std::span<const double> weights, const Eigen::Vector2d& near,
                 double square) {
  double c = 0, s = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!((poses[i].at() - near).squaredNorm() <= square)) continue;
    c += weights[i] * std::cos(poses[i].yaw);
    s += weights[i] * std::sin(poses[i].yaw);
  }
  return std::atan2(s, c);
}

/// Moments of the poses within `radius` metres of `near`.
PoseEstimate moments(std::span<const Pose2> poses, std::span<const double> weights,
                     const Eigen::Vector2d& near, double radius) {
  const double square = radius * radius, ahead = poses.empty() ? 0 : poses[0].yaw;
  double total = 0, x = 0, y = 0, yaw = 0, farthest = 0;  // about a near point: no cancellation far away
  double xx = 0, xy = 0, yy = 0, xt = 0, yt = 0, tt = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double dx = poses[i].x - near.x(), dy = poses[i].y - near.y();
    if (!(dx * dx + dy * dy <= square)) continue;
    const double turn = wrap_angle(poses[i].yaw - ahead), w = weights[i];
    farthest = std::max(farthest, std::abs(turn));
    total += w, x += w * dx, y += w * dy, yaw += w * turn;
  }
  if (!(total > 0)) return {{near.x(), near.y(), 0}, Eigen::Matrix3d::Zero()};
  x /= total, y /= total, yaw = wrap_angle(ahead + yaw / total);
  if (farthest > std::numbers::pi / 2) yaw = direction(poses, weights, near, square);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double dx = poses[i].x - near.x(), dy = poses[i].y - near.y();
    if (!(dx * dx + dy * dy <= square)) continue;
    const double a = dx - x, b = dy - y, t = wrap_angle(poses[i].yaw - yaw), w = weights[i] / total;
    xx += w * a * a, xy += w * a * b, yy += w * b * b, xt += w * a * t, yt += w * b * t, tt += w * t * t;
  }
  PoseEstimate e{{near.x() + x, near.y() + y, yaw}, {}};
  e.covariance << xx, xy, xt, xy, yy, yt, xt, yt, tt;
  return e;
}

}  // namespace

double effective_sample_size(std::span<const double> weights) {
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

std::vector<Pose2> resample_regularized(std::span<const Pose2> poses, std::span<const double> weights,
                                        const PoseEstimate& all, std::size_t count, Random& random) {
  const double blur = std::pow(0.8 / static_cast<double>(std::max<std::size_t>(count, 2)), 2.0 / 7);
  const double keep = std::sqrt(1 - blur);
  const Eigen::Matrix3d root = square_root(blur * all.covariance);
  const Ziggurat& normal = Ziggurat::instance();
  std::vector<Pose2> next;
  next.reserve(count);
  for (const std::uint32_t i : resample(weights, count, random.uniform())) {
    const Pose2& p = poses[i];
    const double a = normal(random), b = normal(random), c = normal(random);
    next.push_back({all.pose.x + keep * (p.x - all.pose.x) + root(0, 0) * a,
                    all.pose.y + keep * (p.y - all.pose.y) + root(1, 0) * a + root(1, 1) * b,
                    wrap_angle(all.pose.yaw + keep * wrap_angle(p.yaw - all.pose.yaw) + root(2, 0) * a +
                               root(2, 1) * b + root(2, 2) * c)});
  }
  return next;
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
                      std::floor(wrap_angle(p.yaw) / radians));
  std::ranges::sort(bins);
  return static_cast<std::size_t>(std::unique(bins.begin(), bins.end()) - bins.begin());
}

PoseEstimate dominant_mode(std::span<const Pose2> poses, std::span<const double> weights, double radius) {
  const PoseEstimate all = moments(poses, weights);
  if (std::sqrt(all.covariance(0, 0) + all.covariance(1, 1)) < radius / 3) return all;
  // Finds the heaviest cell, then its surroundings.
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

}  // namespace waymark::localization
