// SPDX-License-Identifier: Apache-2.0
#include "planning/obstacle_memory.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/rock_abundance.hpp"

namespace waymark::planning {
namespace {

constexpr double kMinProbability = 0.1;       // of an object that may be a hazard
constexpr double kSurelySeen = 8;             // m: an obstacle ahead and nearer than this is seen again
constexpr double kAhead = 0.5;                // rad to each side
constexpr double kForgotten = 30;             // m from the vehicle
constexpr double kGate = 0.6;                 // m between sightings of one obstacle, beside their radii
constexpr double kFirst = 0.7, kAgain = 1.2;  // log odds of a first and a further sighting
constexpr double kMissed = -0.9, kGone = -1, kSurest = 4;

Eigen::Vector2d moved(const localization::Pose2& a_from_b, const Eigen::Vector2d& in_b) {
  return (a_from_b * localization::Pose2{in_b.x(), in_b.y(), 0}).at();
}

}  // namespace

HazardObject hazard_seen(const localization::SeenLandmark& seen, const localization::Pose2& robot_from_sensor,
                         const TypeRegistry& types, const Vehicle& vehicle, double min_height) {
  if (!seen.type || *seen.type >= types.size() || !seen.has_position() || !seen.is_valid())
    return {.probability = 0};
  const LandmarkType& type = types[*seen.type];
  Landmark landmark;
  landmark.type = *seen.type;
  landmark.confidence = seen.confidence;
  const Eigen::Vector2d at = moved(
      robot_from_sensor, *seen.range * Eigen::Vector2d(std::cos(*seen.bearing), std::sin(*seen.bearing)));
  landmark.position.xyz.head<2>() = at;
  landmark.features.resize(type.features.size());
  std::optional<double> radius;
  for (std::size_t i = 0; i < std::min(type.features.size(), localization::kMaxFeatures); ++i) {
    const double value = seen.features.value[i];
    if (!(std::isfinite(value) && value > 0)) continue;
    landmark.features[i] = {value, seen.features.variance[i], 1};
    if (type.features[i].name == type.body.feature) radius = value * type.body.radius_per_value;
  }
  for (std::size_t i = 0; i < type.features.size(); ++i)
    if (type.features[i].name == "height" && landmark.features[i].observations == 0)
      landmark.features[i] = {std::max(min_height, 2 * kRockHeightPerDiameter * radius.value_or(0)), 0, 1};
  HazardObject object = hazard_object(landmark, type, vehicle);
  const double sideways = *seen.range * seen.bearing_sd;
  object.covariance =
      Eigen::Matrix2d::Identity() * std::max(seen.range_sd * seen.range_sd, sideways * sideways);
  return object;
}

void ObstacleMemory::confirm_all() {
  for (SeenObstacle& o : obstacles_) o.log_odds = std::max(o.log_odds, SeenObstacle::kConfirmed);
}

void ObstacleMemory::add(std::span<const HazardObject> seen, const localization::Pose2& odometry_from_robot) {
  std::vector<char> again(obstacles_.size(), 0);
  for (const HazardObject& object : seen) {
    if (!(object.probability >= kMinProbability)) continue;
    const Eigen::Vector2d at = moved(odometry_from_robot, object.position);
    const double radius = object.radius + 2 * object.radius_sd;
    std::size_t nearest = obstacles_.size();
    double min_distance = kGate + radius;
    for (std::size_t i = 0; i < obstacles_.size(); ++i)
      if (const double d = (obstacles_[i].at - at).norm(); d < min_distance) min_distance = d, nearest = i;
    if (nearest == obstacles_.size()) {
      obstacles_.push_back({at, radius, kFirst});
      again.push_back(1);
      continue;
    }
    SeenObstacle& known = obstacles_[nearest];
    if (!again[nearest]) known.log_odds = std::min(kSurest, known.log_odds + kAgain);
    again[nearest] = 1;
    known.at = at, known.radius = std::max(radius, 0.8 * known.radius);  // the latest is the nearest
  }
  const localization::Pose2 robot_from_odometry = localization::inverse(odometry_from_robot);
  std::vector<SeenObstacle> kept;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    SeenObstacle o = obstacles_[i];
    const Eigen::Vector2d to = moved(robot_from_odometry, o.at);
    const double range = to.norm();
    if (!again[i] && range < kSurelySeen && std::abs(std::atan2(to.y(), to.x())) < kAhead)
      o.log_odds += kMissed;
    if (range < kForgotten && o.log_odds > kGone) kept.push_back(o);
  }
  obstacles_ = std::move(kept);
}

}  // namespace waymark::planning
