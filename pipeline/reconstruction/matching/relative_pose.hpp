// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>
namespace waymark::pipeline {

/// Motion between two cameras: x_second = rotation x_first + distance direction.
struct RelativePose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit vector; zero for a rotation
};

/// Rays of one match, unit vectors in the frames of both cameras.
struct RayPair {
  Eigen::Vector3d first, second;
};

/// Agreement of matches with a pose.
struct PoseScore {
  double score = 0;
  std::vector<std::size_t> inliers = {};
};

/// Scores a pose by the matches that agree with it. Their rays lie in one epipolar plane within `threshold`
/// radians, and their points lie before both cameras.
PoseScore score_pose(const RelativePose& pose, std::span<const RayPair> pairs, double threshold);

/// Refines a pose by Gauss-Newton over its five parameters, with the inliers of each round.
RelativePose refine_pose(RelativePose pose, std::span<const RayPair> pairs, double threshold);

/// Rotation that turns first rays onto second ones.
struct FittedRotation {
  Eigen::Matrix3d rotation;
  std::size_t inliers = 0;  ///< pairs within the threshold
};

/// Fits the rotation (Kabsch), reweighted, from a start; `threshold` in radians.
FittedRotation fit_rotation(std::span<const RayPair> pairs, double threshold, Eigen::Matrix3d rotation);

}  // namespace waymark::pipeline
