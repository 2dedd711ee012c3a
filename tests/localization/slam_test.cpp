// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "localization/ekf_slam.hpp"
#include "made_world.hpp"

namespace waymark::testing {
namespace {

// Two rounds of a circle without a map: what was seen in the first round holds the second.
TEST(EkfSlam, ASecondRoundIsHeldByTheFirst) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    MadeDrive drive(seed, 60, false);
    SlamOptions options;
    options.most_range = 12;
    options.nearest = 0.5;
    PoseEstimate start{drive.truth(), Eigen::Matrix3d::Identity() * 1e-6};
    EkfSlam slam(start, options);
    DeadReckoning odometry(start);
    for (int i = 0; i < 250; ++i) {
      const BodyMotion step = drive.drive();
      slam.move(step);
      odometry.move(step);
      slam.see(drive.look());
      ASSERT_TRUE(slam.estimate().pose.finite());
      ASSERT_TRUE(slam.estimate().covariance.allFinite());
    }
    EXPECT_LT((slam.estimate().pose.at() - drive.truth().at()).norm(), 1) << "seed " << seed;
    EXPECT_LT(slam.estimate().covariance(0, 0), 0.3 * odometry.estimate().covariance(0, 0));
    EXPECT_GT(slam.landmarks().size(), 5u);
    EXPECT_LT(slam.landmarks().size(), 75u) << "60 there are";
  }
}

}  // namespace
}  // namespace waymark::testing
