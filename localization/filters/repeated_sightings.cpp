// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/repeated_sightings.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

namespace waymark::localization {
namespace {

constexpr double kSame = 9.2;     // squared distance of one landmark's sightings: 99 % of chi-square, 2 dof
constexpr double kForgotten = 4;  // correlation times after which a correlation of 2 % is left
constexpr double kWidest = 1e3;   // limit for two sightings at one time

double widening(double seconds, double memory) {
  if (!(memory > 0)) return 1;
  const double alike = std::exp(-seconds / memory);
  return std::min(std::sqrt((1 + alike) / std::max(1 - alike, 1e-12)), kWidest);
}

}  // namespace

void RepeatedSightings::predict(const BodyMotion& motion) {
  const MotionCompensation after(motion);
  for (Last& p : last_) after.apply(p.at, p.covariance);
}

void RepeatedSightings::widen(SightingSet& seen, double t) {
  const double longest = kForgotten * std::max(memory_.range, memory_.bearing);
  if (!(longest > 0)) return;
  std::erase_if(last_, [&](const Last& p) { return !(t - p.t < longest); });
  std::vector<bool> taken(last_.size(), false);
  const std::size_t before = last_.size();
  for (SeenLandmark& s : seen.sightings) {
    if (!s.is_valid() || !s.range) continue;
    const double along = seen.robot_from_sensor.yaw + s.bearing;
    const Eigen::Matrix2d r = Eigen::Rotation2Dd(along).toRotationMatrix();
    const Eigen::Vector2d sd(s.range_sd, *s.range * std::min(s.bearing_sd, 1.0));
    const Last now{.at = seen.robot_from_sensor.at() + r.col(0) * *s.range,
                   .covariance = r * sd.cwiseAbs2().asDiagonal() * r.transpose(),
                   .type = s.type,
                   .t = t};
    std::optional<std::size_t> nearest;
    double least = kSame;
    for (std::size_t i = 0; i < before; ++i) {
      if (taken[i] || last_[i].type != s.type) continue;
      const Eigen::Vector2d d = last_[i].at - now.at;
      const double squares = d.dot((last_[i].covariance + now.covariance).inverse() * d);
      if (squares <= least) least = squares, nearest = i;
    }
    if (!nearest) {
      last_.push_back(now);
      continue;
    }
    taken[*nearest] = true;
    const double seconds = std::max(0.0, t - last_[*nearest].t);
    last_[*nearest] = now;
    s.range_sd *= widening(seconds, memory_.range);
    s.bearing_sd *= widening(seconds, memory_.bearing);
  }
}

}  // namespace waymark::localization
