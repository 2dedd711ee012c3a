// SPDX-License-Identifier: Apache-2.0
#include "tests/testbed/dead_reckoning.hpp"

#include <Eigen/LU>

#include "localization/motion_model.hpp"
#include "localization/persistent_errors.hpp"
#include "testbed/drive/odometry_errors.hpp"

namespace waymark::test {

double squared_error_of_odometry(const testbed::DriveWorld& world) {
  const testbed::OdometryErrors stated = testbed::odometry_errors(world.settings, world.steps);
  localization::PersistentErrors drift(stated.drift);
  localization::PoseEstimate at{world.steps.front().at.plane, 1e-9 * Eigen::Matrix3d::Identity()};
  for (std::size_t i = 0; i + 1 < world.steps.size(); ++i) {
    const testbed::DriveStep& step = world.steps[i];
    const double dt = world.steps[i + 1].t - step.t;
    at = predict_pose(
        at, drift.correct(at, localization::twist_motion(step.speed, 0, step.turn, dt, stated.noise), dt));
  }
  const Eigen::Vector2d off = at.pose.at() - world.steps.back().at.plane.at();
  return off.dot(at.covariance.topLeftCorner<2, 2>().inverse() * off) / 2;
}

}  // namespace waymark::test
