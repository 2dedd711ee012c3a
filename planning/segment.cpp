// SPDX-License-Identifier: Apache-2.0
#include "planning/segment.hpp"

#include <Eigen/LU>

namespace waymark::planning {

Eigen::Matrix3d Segment::apply(const Eigen::Matrix3d& covariance) const {
  const Eigen::Matrix3d kept = (Eigen::Matrix3d::Identity() + information * covariance).inverse();
  return spread + transition * covariance * kept * transition.transpose();
}

Segment drive_segment(const DriveStep& step, const Symmetric3& information,
                      const localization::OdometryNoise& noise) {
  Segment driven, seen;
  driven.transition(0, 2) = -step.length * step.north;
  driven.transition(1, 2) = step.length * step.east;
  driven.spread = predict({}, step, noise).matrix();
  seen.information = information.matrix();
  return star(driven, seen);
}

Segment star(const Segment& first, const Segment& second) {
  const Eigen::Matrix3d kept = (Eigen::Matrix3d::Identity() + first.spread * second.information).inverse();
  const Eigen::Matrix3d through = second.transition * kept;
  Segment both;
  both.transition = through * first.transition;
  both.information =
      first.information + first.transition.transpose() * second.information * kept * first.transition;
  both.spread = second.spread + through * first.spread * second.transition.transpose();
  // Rounding must not accumulate in the parts that are symmetric.
  both.information = ((both.information + both.information.transpose()) / 2).eval();
  both.spread = ((both.spread + both.spread.transpose()) / 2).eval();
  return both;
}

Symmetric3 covariance_after(Segment segment, int doublings) {
  for (int i = 0; i < doublings; ++i) segment = star(segment, segment);
  return symmetric(segment.spread);
}

}  // namespace waymark::planning
