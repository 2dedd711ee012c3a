// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/bearing_starts.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace waymark::localization {
namespace {

constexpr double kMinRange = 0.5;      // m
constexpr double kBearingSigmas = 3;   // of a bearing that may be of an object
constexpr double kRangeError = 0.2;    // largest relative standard deviation of the distance of a landmark
constexpr double kForgetBearing = 60;  // m driven
constexpr std::size_t kMinLooks = 3;   // bearings of an object that starts a landmark
constexpr std::size_t kMaxLooks = 12, kMaxObjects = 200;

/// Ray in the robot's frame of now.
struct Ray {
  Eigen::Vector2d from;
  double angle;

  Eigen::Vector2d at(double range) const {
    return from + range * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  double bearing_of(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d to = point - from;
    return wrap_angle(std::atan2(to.y(), to.x()) - angle);
  }
};

Ray ray_now(const Pose2& step, const Pose2& mount, double bearing) {
  const Pose2 sensor = inverse(step) * mount;
  return {sensor.at(), sensor.yaw + bearing};
}

/// Returns where two rays meet in front of both; `std::nullopt` if they do not.
std::optional<Eigen::Vector2d> meet(const Ray& a, const Ray& b) {
  const double sine = std::sin(b.angle - a.angle);
  if (!(std::abs(sine) > 1e-6)) return {};
  const Eigen::Vector2d d = b.from - a.from;
  const double range = (d.x() * std::sin(b.angle) - d.y() * std::cos(b.angle)) / sine;
  const Eigen::Vector2d point = a.at(range);
  const double other = (point - b.from).dot(Eigen::Vector2d(std::cos(b.angle), std::sin(b.angle)));
  if (!(range > kMinRange && other > kMinRange)) return {};
  return point;
}

}  // namespace

void BearingStarts::predict(const BodyMotion& motion) {
  for (Object& object : objects_)
    for (Look& look : object.looks) look.since = compose(look.since, motion);
  std::erase_if(objects_,
                [](const Object& o) { return o.looks.front().since.step.at().norm() > kForgetBearing; });
}

// The object lies on the ray of its last bearing, up to `max_range`, so it may now be between two bearings.
bool BearingStarts::may_be(const Object& object, const Look& now) const {
  const Look& last = object.looks.back();
  const Ray before = ray_now(last.since.step, last.mount, last.bearing),
            ray = ray_now({}, now.mount, now.bearing);
  const double a = ray.bearing_of(before.at(kMinRange)),
               b = a + wrap_angle(ray.bearing_of(before.at(max_range_)) - a);
  const double turn = last.since.covariance(2, 2);
  const double margin = kBearingSigmas * std::sqrt(last.sd * last.sd + now.sd * now.sd + turn);
  return std::min(a, b) - margin <= 0 && 0 <= std::max(a, b) + margin;
}

std::optional<BearingStarts::Start> BearingStarts::start(const Object& object) const {
  if (object.looks.size() < kMinLooks) return {};
  const Look &first = object.looks.front(), &last = object.looks.back();
  const auto point = [&](const Eigen::Matrix<double, 5, 1>& off) {
    return meet(
        ray_now(pose_of(first.since.step.vector() + off.tail<3>()), first.mount, first.bearing + off[0]),
        ray_now({}, last.mount, last.bearing + off[1]));
  };
  const auto at = point(Eigen::Matrix<double, 5, 1>::Zero());
  if (!at || at->norm() > max_range_) return {};
  Eigen::Matrix<double, 5, 5> noise = Eigen::Matrix<double, 5, 5>::Zero();
  noise(0, 0) = first.sd * first.sd, noise(1, 1) = last.sd * last.sd;
  noise.bottomRightCorner<3, 3>() = first.since.covariance;
  Eigen::Matrix<double, 2, 5> slope;
  for (int k = 0; k < 5; ++k) {
    Eigen::Matrix<double, 5, 1> off = Eigen::Matrix<double, 5, 1>::Zero();
    off[k] = 1e-6;
    const auto moved = point(off);
    if (!moved) return {};
    slope.col(k) = (*moved - *at) / 1e-6;
  }
  const Eigen::Matrix2d covariance = slope * noise * slope.transpose();
  const Eigen::Vector2d to = (*at - last.mount.at()).normalized();
  const double range = (*at - last.mount.at()).norm();
  if (!(std::sqrt(to.dot(covariance * to)) < kRangeError * range)) return {};
  for (const Look& look : object.looks) {
    const Ray ray = ray_now(look.since.step, look.mount, look.bearing);
    const Eigen::Vector2d from = (*at - ray.from).normalized();
    const double across =
        Eigen::Vector2d(-from.y(), from.x()).dot(covariance * Eigen::Vector2d(-from.y(), from.x()));
    const double sd =
        std::sqrt(look.sd * look.sd + look.since.covariance(2, 2) + across / (*at - ray.from).squaredNorm());
    if (!(std::abs(ray.bearing_of(*at)) < kBearingSigmas * sd)) return {};
  }
  return Start{0, *at, (covariance + covariance.transpose()) / 2};
}

std::vector<BearingStarts::Start> BearingStarts::add(const SightingSet& seen,
                                                     const std::vector<std::size_t>& unmatched,
                                                     bool use_identities) {
  std::vector<Look> looks;
  for (const std::size_t i : unmatched) {
    const SeenLandmark& s = seen.sightings[i];
    looks.push_back({{}, seen.robot_from_sensor, *s.bearing, s.bearing_sd});
  }
  const auto fits = [&](std::size_t k, const Object& o) {
    const SeenLandmark& s = seen.sightings[unmatched[k]];
    const auto identity = use_identities ? s.identity : std::nullopt;
    if (identity || o.identity) return identity == o.identity;
    return s.type == o.type && may_be(o, looks[k]);
  };
  const std::size_t known = objects_.size();
  std::vector<int> of_object(known, 0);
  std::vector<std::vector<std::size_t>> objects(looks.size());
  for (std::size_t k = 0; k < looks.size(); ++k)
    for (std::size_t o = 0; o < known; ++o)
      if (fits(k, objects_[o])) objects[k].push_back(o), ++of_object[o];

  std::vector<Start> starts;
  std::vector<bool> done(known, false);
  for (std::size_t k = 0; k < looks.size(); ++k) {
    const SeenLandmark& s = seen.sightings[unmatched[k]];
    if (objects[k].empty()) {
      if (objects_.size() < kMaxObjects)
        objects_.push_back({use_identities ? s.identity : std::nullopt, s.type, {looks[k]}});
      continue;
    }
    if (objects[k].size() > 1 || of_object[objects[k][0]] > 1) continue;  // ambiguous
    Object& object = objects_[objects[k][0]];
    if (object.looks.size() == kMaxLooks) object.looks.erase(object.looks.begin() + kMaxLooks / 2);
    object.looks.push_back(looks[k]);
    if (auto start = this->start(object)) {
      start->sighting = unmatched[k];
      starts.push_back(*start);
      done[objects[k][0]] = true;
    }
  }
  for (std::size_t o = known; o-- > 0;)
    if (done[o]) objects_.erase(objects_.begin() + static_cast<std::ptrdiff_t>(o));
  return starts;
}

}  // namespace waymark::localization
