// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "localization/body_motion.hpp"
#include "localization/filters/map_errors.hpp"
#include "localization/identification/identification.hpp"
#include "localization/identification/landmark_grid.hpp"
namespace waymark::localization {

/// Covariance of the real errors of a particle filter's pose.
/// - That of the particles is another. They take the errors of the map for new at each sighting, but
///   1 + recent sightings times as large: the cloud is too wide most of the time.
/// - Each update is followed: the gain that the particles' assumptions imply acts on errors that repeat
///   (MapErrors, Schmidt 1966; Joseph form holds for any gain). First order.
/// - Where the cloud is not one Gaussian, or spreads more than its assumptions say, it is that of the cloud.
class CloudCovariance {
 public:
  explicit CloudCovariance(const Eigen::Matrix3d& start = Eigen::Matrix3d::Identity()) : real_(start) {}

  const Eigen::Matrix3d& covariance() const { return real_; }
  /// Takes the covariance of the cloud for that of the errors.
  void reset(const PoseEstimate& cloud) { errors_.clear(), real_ = cloud.covariance; }
  /// Follows a motion from the pose of the cloud.
  void predict(const Pose2& from, const BodyMotion& motion);
  /// Follows an update by matched sightings. `factor` is what the cloud multiplies the map's variance of a
  /// landmark by.
  void follow_sightings(const PoseEstimate& before, const PoseEstimate& after, const SightingSet& seen,
                        const std::vector<Match>& matches, const LandmarkGrid& map,
                        const std::function<double(LandmarkKey)>& factor);
  /// Follows an update by measurements whose noise is independent.
  void follow_independent(const PoseEstimate& before, const PoseEstimate& after);

 private:
  MapErrors errors_;
  Eigen::Matrix3d real_;
};

}  // namespace waymark::localization
