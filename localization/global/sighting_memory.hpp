// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/body_motion.hpp"
#include "localization/sighting.hpp"
namespace waymark {

/// What a robot has seen on its last way, carried along by odometry, as one set of sightings from where it
/// stands now. Sightings of one landmark at different times become one.
class SightingMemory {
 public:
  void move(const BodyMotion& motion);
  void add(const SightingSet& seen);
  void clear() { points_.clear(); }
  /// At most `most` sightings, those best known first.
  SightingSet recall(std::size_t most = 30) const;
  std::size_t size() const { return points_.size(); }

 private:
  struct Point {
    Eigen::Vector2d at;  // from the robot
    Eigen::Matrix2d covariance;
    SeenLandmark seen;
    int times = 1;
  };
  std::vector<Point> points_;
};

/// What is remembered, and those of the set at hand that have no range and are not remembered.
SightingSet with_bearings(SightingSet remembered, const SightingSet& seen);

}  // namespace waymark
