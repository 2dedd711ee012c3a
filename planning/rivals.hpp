// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "landmarks/sensor_profile.hpp"
#include "localization/identification/landmark_grid.hpp"
#include "planning/belief.hpp"
namespace waymark::planning {

/// Landmarks that a sighting of another can be taken for.
///
///   planning::Rivals rivals(map);
///   const double n = rivals.expected(belief, pose, landmark, sensor);  // 0: the sighting is unmistakable
class Rivals {
 public:
  /// `map` must outlive it. Finds each landmark's nearest one of its type.
  explicit Rivals(const localization::LandmarkGrid& map);

  /// Returns how many other landmarks of its type are expected to explain a sighting of a landmark better
  /// than it does: the sum of confidence times Q(d / 2) over them.
  /// - d is their Mahalanobis distance from the landmark. Its covariance is that of the sighting's position:
  ///   belief, errors of both landmarks, noise of the sensor. Q is the upper tail of the normal distribution.
  /// - `pose` is that of the belief, in the frame of the map. A sensor without ranges compares bearings.
  /// - Sizes and the pattern of several sightings are left out, so the number is too large rather than small.
  /// - 20 ns where none is near, 60 ns per rival.
  double expected(const Symmetric3& belief, const localization::Pose2& pose, std::uint32_t landmark,
                  const SensorCoverage& sensor) const;

 private:
  const localization::LandmarkGrid& map_;
  std::vector<double> nearest_;  // m, of the same type; infinity: none
};

}  // namespace waymark::planning
