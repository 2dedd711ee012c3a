// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "planning/belief.hpp"
namespace waymark::planning {

/// What a stretch of a drive does to any covariance P before it:
///   P -> spread + transition P (I + information P)^-1 transition'.
/// Stretches compose by the Redheffer star product, so that n equal ones cost log2(n) products.
struct Segment {
  Eigen::Matrix3d transition = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();

  Eigen::Matrix3d apply(const Eigen::Matrix3d& covariance) const;
};

/// Returns the segment of a step that is driven first and then observed, as predict() and update() do it.
Segment drive_segment(const DriveStep& step, const Symmetric3& information,
                      const localization::OdometryNoise& noise);

/// Returns `first`, then `second`.
Segment star(const Segment& first, const Segment& second);

/// Returns the covariance after 2^doublings equal segments from an exactly known pose.
Symmetric3 covariance_after(Segment segment, int doublings);

}  // namespace waymark::planning
