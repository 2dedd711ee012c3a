// SPDX-License-Identifier: Apache-2.0
#include "localization/global/sighting_memory.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

namespace waymark::localization {
namespace {

constexpr std::size_t kMost = 200;
constexpr double kSame = 9.2;     // squared distance of one landmark's sightings: 99 % of chi-square, 2 dof
constexpr double kBlurred = 0.3;  // standard deviation over range above which a sighting is dropped
constexpr double kTolerance = 0.15;

bool alike(const SeenLandmark& a, const SeenLandmark& b) {
  if (a.identity || b.identity) return a.identity == b.identity;
  if (a.type != b.type) return false;
  for (std::size_t i = 0; i < kMaxFeatures; ++i) {
    if (!a.features.known(i) || !b.features.known(i)) continue;
    const double d = a.features.value[i] - b.features.value[i];
    const double size = kTolerance * std::max(std::abs(a.features.value[i]), std::abs(b.features.value[i]));
    if (d * d > 9 * (a.features.variance[i] + b.features.variance[i] + size * size)) return false;
  }
  return true;
}

}  // namespace

void SightingMemory::predict(const BodyMotion& motion) {
  const MotionCompensation after(motion);
  for (Point& p : points_) after.apply(p.at, p.covariance);
  std::erase_if(points_, [](const Point& p) {
    return !(p.covariance.trace() < kBlurred * kBlurred * std::max(1.0, p.at.squaredNorm()));
  });
}

void SightingMemory::add(const SightingSet& seen) {
  std::vector<Point> fresh;
  std::vector<bool> taken(points_.size(), false);
  for (SeenLandmark s : seen.sightings) {
    if (!s.is_valid() || !s.range || s.type == kNoSuchType) continue;
    if (s.type) s.features = features_without_axes(scales_, *s.type, s.features);
    const double along = seen.robot_from_sensor.yaw + s.bearing;
    const Eigen::Matrix2d r = Eigen::Rotation2Dd(along).toRotationMatrix();
    const Eigen::Vector2d sd(s.range_sd, *s.range * std::min(s.bearing_sd, 1.0));
    Point p{.at = seen.robot_from_sensor.at() + r.col(0) * *s.range,
            .covariance = r * sd.cwiseAbs2().asDiagonal() * r.transpose(),
            .seen = s};
    std::optional<std::size_t> nearest;
    double least = kSame;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (taken[i] || !alike(points_[i].seen, s)) continue;
      const Eigen::Vector2d d = points_[i].at - p.at;
      const double squares = d.dot((points_[i].covariance + p.covariance).inverse() * d);
      if (squares <= least || (s.identity && points_[i].seen.identity == s.identity))
        least = squares, nearest = i;
    }
    if (!nearest) {
      fresh.push_back(p);
      continue;
    }
    taken[*nearest] = true;
    Point& old = points_[*nearest];
    const Eigen::Matrix2d gain = old.covariance * (old.covariance + p.covariance).inverse();
    old.at += gain * (p.at - old.at);
    // Errors of one landmark's sightings are correlated: the mean is no better than the best of them.
    if (p.covariance.trace() < old.covariance.trace()) old.covariance = p.covariance;
    ++old.times;
  }
  points_.insert(points_.end(), fresh.begin(), fresh.end());
  if (points_.size() > kMost)
    points_.erase(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(points_.size() - kMost));
}

SightingSet SightingMemory::recall(std::size_t most) const {
  std::vector<const Point*> order;
  for (const Point& p : points_) order.push_back(&p);
  std::ranges::stable_sort(order, [](const Point* a, const Point* b) {
    const bool a_often = a->times > 1, b_often = b->times > 1;
    return a_often != b_often ? a_often : a->covariance.trace() < b->covariance.trace();
  });
  SightingSet set;
  for (const Point* p : order) {
    if (set.sightings.size() == most) break;
    const double range = p->at.norm();
    if (!(range > 1e-6)) continue;
    const Eigen::Vector2d radial = p->at / range, across(-radial.y(), radial.x());
    SeenLandmark s = p->seen;
    s.range = range;
    s.bearing = std::atan2(p->at.y(), p->at.x());
    s.range_sd = std::sqrt(std::max(1e-12, radial.dot(p->covariance * radial)));
    s.bearing_sd = std::sqrt(std::max(1e-12, across.dot(p->covariance * across))) / range;
    set.sightings.push_back(s);
  }
  return set;
}

SightingSet add_bearings(SightingSet remembered, const SightingSet& seen) {
  for (SeenLandmark s : seen.sightings) {
    if (s.range) continue;
    s.bearing = wrap_angle(s.bearing + seen.robot_from_sensor.yaw);
    remembered.sightings.push_back(s);
  }
  return remembered;
}

}  // namespace waymark::localization
