// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/sighting_follower.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {
namespace {

constexpr double kForget = 5;     // metres driven
constexpr double kSlip = 0.05;    // standard deviation of the distance driven, relative
constexpr double kSigmas = 3;     // of a sighting about its object
constexpr double kCentre = 0.15;  // metres, how far the centre that is seen moves about an object

}  // namespace

void SightingFollower::predict(const BodyMotion& motion) {
  odometry_ = odometry_ * motion.step;
  driven_ += motion.step.at().norm();
}

std::vector<SightingFollower::Seen> SightingFollower::follow(const SightingSet& seen) {
  std::erase_if(objects_, [&](const Object& o) { return driven_ - o.driven > kForget; });
  const Pose2 sensor = odometry_ * seen.robot_from_sensor;
  const std::size_t known = objects_.size();
  std::vector<bool> taken(known, false);
  std::vector<Seen> result;
  for (const SeenLandmark& s : seen.sightings) {
    const auto fresh = [&] { return Seen{count_++, -1}; };
    if (!s.has_position() || !s.is_valid()) {
      result.push_back(fresh());
      continue;
    }
    const double direction = sensor.yaw + *s.bearing;
    const Eigen::Vector2d at =
        sensor.at() + *s.range * Eigen::Vector2d(std::cos(direction), std::sin(direction));
    std::optional<std::size_t> nearest;
    double min_distance = 0;
    for (std::size_t i = 0; i < known; ++i) {
      const Object& o = objects_[i];
      const double metres = driven_ - o.driven, distance = (o.at - at).norm();
      const double sd = std::hypot(std::hypot(s.range_sd, *s.range * s.bearing_sd), kSlip * metres, kCentre);
      if (taken[i] || !may_share_type(o.seen, s) || distance > kSigmas * sd ||
          (nearest && distance >= min_distance))
        continue;
      nearest = i, min_distance = distance;
    }
    if (!nearest) {
      result.push_back(fresh());
      objects_.push_back({result.back().object, at, s, driven_});
      continue;
    }
    Object& object = objects_[*nearest];
    taken[*nearest] = true;
    result.push_back({object.number, driven_ - object.driven});
    object.at = at, object.driven = driven_;
  }
  return result;
}

}  // namespace waymark::localization
