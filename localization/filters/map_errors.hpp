// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/identification/map_landmark.hpp"
#include "localization/pose2.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Covariances of a pose with the map errors of the landmarks that it was corrected by.
/// A landmark's error on the map is the same at each sighting. The filter considers it without estimating it
/// (Schmidt 1966): however often a landmark is seen, the pose never becomes more certain than the landmark.
/// Errors of different landmarks count as independent.
class MapErrors {
 public:
  /// `memory`: metres after which a landmark not seen meanwhile is forgotten; 0: each sighting has a new
  /// error.
  explicit MapErrors(double memory = 200) : memory_(memory) {}

  /// Follows a prediction of the pose from `before` by a step.
  void predict(const Pose2& before, const Pose2& step);
  /// Follows a correction of the pose by measurements that do not depend on the map.
  void follow(const PoseEstimate& before, const PoseEstimate& after);
  /// Returns the pose corrected by a sighting, Joseph form. `trust` in (0, 1] divides the noise. `unscented`:
  /// linear regression over sigma points instead of derivatives.
  PoseEstimate correct(const PoseEstimate& before, const SeenLandmark& seen, const Pose2& robot_from_sensor,
                       const MapLandmark& landmark, double trust, bool unscented = false);
  /// Returns the same for a sighting that shows the landmark with a probability: the mixture of the poses
  /// with and without the correction, as one Gaussian (probabilistic data association).
  PoseEstimate correct_probably(const PoseEstimate& before, const SeenLandmark& seen,
                                const Pose2& robot_from_sensor, const MapLandmark& landmark, double trust,
                                double probability, bool unscented = false);
  /// Covariance of a pose's errors, and the covariance that its localizer assumes and corrects it by.
  struct Covariances {
    Eigen::Matrix3d real, assumed;
  };
  /// Returns the covariances after a correction at `pose`. The localizer takes all errors for independent,
  /// and the map's variance for `factor` times as large.
  Covariances follow(const Pose2& pose, const Covariances& before, const SeenLandmark& seen,
                     const Pose2& robot_from_sensor, const MapLandmark& landmark, double factor);
  /// Becomes those of a mixture of two poses, with weights 1 - `other_weight` and `other_weight`.
  void mix(const MapErrors& other, double other_weight);
  /// Forgets all: the pose is a new one.
  void clear() { errors_.clear(); }

  std::size_t size() const { return errors_.size(); }

 private:
  using WithLandmark = Eigen::Matrix<double, 3, 2>;  // covariance of pose and landmark
  struct Entry {
    LandmarkKey key;
    WithLandmark covariance;
    double driven;                // at the last sighting, m
    Eigen::Matrix2d information;  // inverse covariance of the landmark's error at the last sighting
  };
  struct Linear;
  Linear linear_sighting(const PoseEstimate& before, const SeenLandmark& seen, const Pose2& robot_from_sensor,
                         const MapLandmark& landmark, double trust, bool unscented) const;
  Eigen::Matrix3d apply(const Linear& line, const WithLandmark& gain, const Eigen::Matrix3d& before);
  void drop_old();
  void limit_jointly(const Eigen::Matrix3d& pose);

  double memory_, driven_ = 0;
  bool is_limited_ = false;    // since the last prediction; corrections keep what the pose allows
  std::vector<Entry> errors_;  // by key
};

}  // namespace waymark::localization
