// SPDX-License-Identifier: Apache-2.0
// The belief of pose and persistent odometry errors against drives that have them, and against its parts.
#include "planning/odometry_belief.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "core/random.hpp"

namespace waymark::test {
namespace {

using namespace planning;

constexpr Odometry kRover{
    .noise = {.along_per_metre = 1e-5, .across_per_metre = 1e-5, .yaw_per_metre = 1e-5, .yaw_per_radian = 0},
    .drift =
        {.scale_sd = 0.03, .slip_sd = 0.03, .sideways_sd = 0.01, .drift_distance = 10, .yaw_rate_sd = 4e-4},
    .speed = 0.5};

struct Leg {
  double length, yaw;
};
constexpr std::array<Leg, 3> kRoute{{{40, 0}, {30, 0.8}, {40, -0.5}}};

Symmetric3 start() {
  return {0.01, 0, 0.01, 0, 0, 3e-4};
}

DriveBelief believe(const Odometry& odometry, double step) {
  DriveBelief belief(start(), odometry);
  for (const Leg& leg : kRoute)
    for (double driven = 0; driven < leg.length - 1e-9; driven += step)
      belief.drive({step, std::cos(leg.yaw), std::sin(leg.yaw), 0});
  return belief;
}

TEST(DriveBelief, AtOneSpeedABiasOfTheCurvatureIsOneOfTheTurnRate) {
  Odometry curved = kRover;
  curved.drift.curvature_sd = kRover.drift.yaw_rate_sd / kRover.speed;
  curved.drift.yaw_rate_sd = 0;
  EXPECT_NEAR((believe(curved, 0.5).pose().matrix() - believe(kRover, 0.5).pose().matrix()).norm(), 0, 1e-12);
  EXPECT_NEAR(curved.white().yaw_per_metre, kRover.white().yaw_per_metre, 1e-15);
}

/// Errors of the pose after one drive on the route, x, y, yaw.
Eigen::Vector3d drive_with_errors(Random& random) {
  const auto& [noise, drift, speed] = kRover;
  const double step = 0.5, fade = std::exp(-step / drift.drift_distance);
  Eigen::Vector3d error(0.1 * random.normal(), 0.1 * random.normal(), std::sqrt(3e-4) * random.normal());
  const double scale = drift.scale_sd * random.normal(), rate = drift.yaw_rate_sd * random.normal();
  double slip = drift.slip_sd * random.normal(), sideways = drift.sideways_sd * random.normal();
  for (const Leg& leg : kRoute)
    for (double driven = 0; driven < leg.length; driven += step) {
      const double along = (scale + slip) * step + std::sqrt(noise.along_per_metre * step) * random.normal();
      const double turned = rate * step / speed + std::sqrt(noise.yaw_per_metre * step) * random.normal();
      const double across = sideways * step + (error[2] + turned / 2) * step +
                            std::sqrt(noise.across_per_metre * step) * random.normal();
      error.head<2>() += Eigen::Rotation2Dd(leg.yaw) * Eigen::Vector2d(along, across);
      error[2] += turned;
      const double fresh = std::sqrt(1 - fade * fade);
      slip = fade * slip + fresh * drift.slip_sd * random.normal();
      sideways = fade * sideways + fresh * drift.sideways_sd * random.normal();
    }
  return error;
}

TEST(DriveBelief, IsTheSpreadOfDrivesWithPersistentErrors) {
  Random random(3, "drives");
  constexpr int drives = 20000;  // a variance is known to 1 %
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int i = 0; i < drives; ++i) {
    const Eigen::Vector3d error = drive_with_errors(random);
    spread += error * error.transpose() / drives;
  }
  const Eigen::Matrix3d planned = believe(kRover, 0.5).pose().matrix();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(planned(i, j), spread(i, j), 0.04 * std::sqrt(spread(i, i) * spread(j, j))) << i << j;
}

TEST(DriveBelief, StepsOfACellAreShortEnough) {
  EXPECT_NEAR(position_sd(believe(kRover, 2).pose()), position_sd(believe(kRover, 0.1).pose()),
              0.03 * position_sd(believe(kRover, 0.1).pose()));
}

TEST(DriveBelief, WithoutPersistentErrorsItIsThatOfTheSearch) {
  const localization::OdometryNoise noise;
  DriveBelief belief(start(), {noise, {}, 0.5});
  Symmetric3 p = start();
  for (int i = 0; i < 20; ++i) {
    const DriveStep step{2, std::cos(0.3 * i), std::sin(0.3 * i), 0.3};
    const Symmetric3 information{0.2 * (i % 3), 0.05, 0.3, 0.01, 0.02, 0.5};
    p = update(predict(p, step, noise), information);
    belief.drive(step);
    belief.see(information);
    EXPECT_TRUE(belief.pose().matrix().isApprox(p.matrix(), 1e-9)) << i;
  }
}

TEST(DriveBelief, LandmarksTeachWhatPersists) {
  // The same desert after landmarks: what was learned of scale and turn rate makes it smaller.
  const Symmetric3 fix{1e4, 0, 1e4, 0, 0, 1e5};
  DriveBelief first(start(), kRover), after(start(), kRover);
  first.see(fix);
  for (int i = 0; i < 20; ++i) after.drive({2, 1, 0, 0}), after.see(fix);
  for (int i = 0; i < 30; ++i) first.drive({2, 1, 0, 0}), after.drive({2, 1, 0, 0});
  EXPECT_LT(position_sd(after.pose()), 0.8 * position_sd(first.pose()));
}

TEST(Odometry, WhiteNoiseOfSlipHasItsSpreadAfterManyDriftDistances) {
  Odometry slips = kRover;
  slips.drift.scale_sd = slips.drift.yaw_rate_sd = 0;
  DriveBelief belief({}, slips);
  Symmetric3 white;
  for (int i = 0; i < 200; ++i) {
    belief.drive({1, 1, 0, 0});
    white = predict(white, {1, 1, 0, 0}, slips.white());
  }
  EXPECT_NEAR(std::sqrt(white.xx / belief.pose().xx), 1, 0.05);
}

}  // namespace
}  // namespace waymark::test
