// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/body_motion.hpp"
#include "localization/identification/feature_distance.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Recent sightings of a robot, predicted by odometry to its present frame, as one set. Sightings of one
/// landmark at different times are merged.
class SightingMemory {
 public:
  /// `scales` name the features that turn with the robot, which are not remembered.
  explicit SightingMemory(FeatureScales scales = {}) : scales_(std::move(scales)) {}

  void predict(const BodyMotion& motion);
  void add(const SightingSet& seen);
  void clear() { points_.clear(); }
  /// Returns at most `most` sightings, the most precise first.
  SightingSet recall(std::size_t most = 30) const;
  std::size_t size() const { return points_.size(); }

 private:
  struct Point {
    Eigen::Vector2d at;  // from the robot
    Eigen::Matrix2d covariance;
    SeenLandmark seen;
    int times = 1;
  };
  FeatureScales scales_;
  std::vector<Point> points_;
};

/// Adds to remembered sightings those of the current set without range, which are not remembered.
SightingSet add_bearings(SightingSet remembered, const SightingSet& seen);

}  // namespace waymark::localization
