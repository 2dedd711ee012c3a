// SPDX-License-Identifier: Apache-2.0
// Star products against the loop that they replace, and what a place gives a localizer.
#include "planning/observability.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace waymark::test {
namespace {

using namespace planning;
using localization::OdometryNoise;

Symmetric3 random_information(Random& random) {
  const int rank = static_cast<int>(random.uniform(0, 4));  // 0 to 3
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int i = 0; i < rank; ++i) {
    const Eigen::Vector3d row(random.normal(), random.normal(), random.normal());
    sum += std::exp(random.uniform(-6, 6)) * row * row.transpose();
  }
  return symmetric(sum);
}

TEST(Segment, StarProductsAreTheLoopOfPredictionsAndUpdates) {
  Random random(7, "segments");
  for (int i = 0; i < 300; ++i) {
    const double yaw = random.uniform(-4, 4);
    const DriveStep step{random.uniform(0.1, 2), std::cos(yaw), std::sin(yaw), 0};
    const Symmetric3 information = random_information(random);
    const OdometryNoise noise{.along_per_metre = random.uniform(0.001, 0.1),
                              .yaw_per_metre = random.uniform(1e-5, 1e-2)};
    Symmetric3 slow{1e-12, 0, 1e-12, 0, 0, 1e-12};  // update() needs a positive definite one
    for (int n = 0; n < 64; ++n) slow = update(predict(slow, step, noise), information);
    const Symmetric3 fast = covariance_after(drive_segment(step, information, noise), 6);
    EXPECT_TRUE(fast.matrix().isApprox(slow.matrix(), 1e-5)) << fast.matrix() << "\n\n" << slow.matrix();
  }
}

TEST(Segment, IsAssociativeAndAppliesInTurn) {
  Random random(8, "segments");
  for (int i = 0; i < 100; ++i) {
    const auto one = [&] {
      return drive_segment({random.uniform(0.1, 2), 0.6, 0.8, 0}, random_information(random), {});
    };
    const Segment a = one(), b = one(), c = one();
    const Segment left = star(star(a, b), c), right = star(a, star(b, c));
    EXPECT_TRUE(left.spread.isApprox(right.spread, 1e-7));
    EXPECT_TRUE(left.transition.isApprox(right.transition, 1e-6) ||
                (left.transition - right.transition).norm() < 1e-9);
    const Eigen::Matrix3d p = Eigen::Vector3d(0.1, 0.2, 0.01).asDiagonal();
    EXPECT_TRUE(left.apply(p).isApprox(c.apply(b.apply(a.apply(p))), 1e-6));
  }
}

localization::LandmarkGrid row_of_landmarks(int count) {
  std::vector<localization::MapLandmark> all;
  for (int i = 0; i < count; ++i) {
    localization::MapLandmark l;
    l.at = {5.0 * i, 10};
    l.covariance = Eigen::Matrix2d::Identity() * 1e-4;
    l.quality = 1;
    all.push_back(l);
  }
  return localization::LandmarkGrid(all);
}

ObservabilityRules laser(double view = 360) {
  ObservabilityRules rules;
  rules.sensing.coverage.range = 20;
  rules.sensing.coverage.view = view;
  rules.sensing.coverage.range_sd = 0.05;
  rules.sensing.coverage.bearing_sd = 0.5;
  return rules;
}

TEST(Observability, FarFromLandmarksItIsThatOfOdometry) {
  const Observability at = observability_at(0, 500, row_of_landmarks(20), laser());
  const Symmetric3 odometry = predict({}, {100, 1, 0, 0}, {});
  EXPECT_NEAR(at.position_sd, position_sd(odometry), 1e-6 * at.position_sd);
  EXPECT_EQ(at.landmarks, 0);
}

TEST(Observability, MoreLandmarksAreBetter) {
  double before = 1e9;
  for (const int count : {0, 1, 2, 4, 8}) {
    const Observability at = observability_at(10, 0, row_of_landmarks(count), laser());
    EXPECT_LT(at.position_sd, before + 1e-12) << count;
    before = at.position_sd;
  }
  EXPECT_LT(before, 0.1);
}

TEST(Observability, ANarrowViewSeesLandmarksOfSomeHeadings) {
  const auto map = row_of_landmarks(8);
  const Observability wide = observability_at(17, 0, map, laser()),
                      narrow = observability_at(17, 0, map, laser(60));
  EXPECT_LT(narrow.landmarks, wide.landmarks);
  EXPECT_GT(narrow.landmarks, 0);
  // Of the heading away from the row.
  EXPECT_NEAR(narrow.position_sd, position_sd(predict({}, {100, 1, 0, 0}, {})), 0.01 * narrow.position_sd);
}

TEST(Observability, LandmarksBehindAHillAreNotSeen) {
  const auto map = row_of_landmarks(8);  // x from 0 to 35, y = 10
  ObservabilityRules hill = laser();
  const auto ridge = [](const Eigen::Vector2d& at) -> std::optional<double> {
    return at.x() > 15 && at.x() < 19 ? 5.0 : 0.0;
  };
  hill.sensing.visible = localization::terrain_line_of_sight(ridge, {});
  const Observability open = observability_at(10, 0, map, laser()),
                      behind = observability_at(10, 0, map, hill);
  EXPECT_EQ(open.landmarks, 6);    // x up to 25
  EXPECT_EQ(behind.landmarks, 4);  // not those at 20 and 25
  EXPECT_GT(behind.position_sd, open.position_sd);
}

TEST(Observability, AFieldIsThatOfItsPositions) {
  const auto map = row_of_landmarks(8);
  for (const double view : {360.0, 90.0}) {
    const ObservabilityRules rules = laser(view);
    const ObservabilityField field(map, rules);
    for (const double y : {0.0, 8.0, 25.0, 500.0}) {
      const auto fast = observability_bands(field.at(12, y)),
                 slow = observability_bands(observability_at(12, y, map, rules));
      EXPECT_EQ(fast, slow) << y;
    }
  }
}

TEST(Observability, ALineOfSightIsTestedOncePerPlace) {
  ObservabilityRules rules = laser(120);  // eight headings
  int tests = 0;
  rules.sensing.visible = [&](const localization::Pose2&, const Eigen::Vector2d&) { return ++tests > 0; };
  const Observability at = observability_at(10, 0, row_of_landmarks(8), rules);
  EXPECT_EQ(tests, 6);
  ObservabilityRules free = laser(120);
  EXPECT_EQ(at.position_sd, observability_at(10, 0, row_of_landmarks(8), free).position_sd);
}

}  // namespace
}  // namespace waymark::test
