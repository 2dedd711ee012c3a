// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <vector>
namespace waymark::inline geo {

/// Similarity transform: map = scale * rotation * frame + shift.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return scale * (rotation * point) + shift; }
};

/// Estimates a similarity from corresponding points by least squares (Umeyama 1991), never a reflection.
/// Throws Error{input} for fewer than 3 points, unequal counts, or points on one line, which leave the
/// rotation about it open.
Similarity estimate_similarity(const std::vector<Eigen::Vector3d>& frame,
                               const std::vector<Eigen::Vector3d>& map);

/// Returns the root mean square distance between similarity * frame and map, metres.
double residual(const Similarity& similarity, const std::vector<Eigen::Vector3d>& frame,
                const std::vector<Eigen::Vector3d>& map);

}  // namespace waymark::inline geo
