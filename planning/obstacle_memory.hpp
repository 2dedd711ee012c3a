// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "landmarks/landmark_type.hpp"
#include "localization/sighting.hpp"
#include "planning/object_hazard.hpp"
namespace waymark::planning {

/// Returns a sighting as an object in the robot's axes; its probability is 0 without a type or a range.
/// - A sighting without height is of an object that reaches `min_height` metres: a line scanner sees only
///   what is higher than itself.
HazardObject hazard_seen(const localization::SeenLandmark& seen, const localization::Pose2& robot_from_sensor,
                         const TypeRegistry& types, const Vehicle& vehicle, double min_height);

/// Object that stands in the way, in the frame of dead reckoning.
struct SeenObstacle {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double radius = 0;    ///< metres, with two standard deviations
  double log_odds = 0;  ///< of its existence
  bool confirmed() const { return log_odds >= kConfirmed; }
  static constexpr double kConfirmed = 1.5;
};

/// Obstacles that the vehicle's own sensors saw. They are kept in the frame of dead reckoning: what was seen
/// some metres ago does not jump when the localizer corrects its pose.
class ObstacleMemory {
 public:
  /// Adds the objects of a set of sightings that may be hazards (in the robot's axes, probability of at least
  /// 0.1). An obstacle right ahead that is not seen again loses probability, and is forgotten; so are those
  /// that lie over 30 m away.
  void add(std::span<const HazardObject> seen, const localization::Pose2& odometry_from_robot);

  /// Takes all obstacles as confirmed: those that looking again did not rule out.
  void confirm_all();

  const std::vector<SeenObstacle>& obstacles() const { return obstacles_; }

 private:
  std::vector<SeenObstacle> obstacles_;
};

}  // namespace waymark::planning
