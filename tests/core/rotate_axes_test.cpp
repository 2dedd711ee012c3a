// SPDX-License-Identifier: Apache-2.0
#include "core/rotate_axes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace waymark::test {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

TEST(RotatedAxes, GiveACovarianceTheErrorsOfRotatedPositions) {
  Random random(3, "rotated errors");
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) root(i, j) = random.normal();
  const Eigen::Matrix3d covariance = root * root.transpose();
  const double rotation = 0.7;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(rotation, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_LE((rotate_axes(covariance, rotation) - turn * covariance * turn.transpose()).norm(), 1e-12);
  EXPECT_EQ(rotate_axes(covariance, 0), covariance);
}

TEST(RotatedAxes, KeepWhatIsUnknown) {
  Eigen::Matrix3d covariance = Eigen::Vector3d(4, 1, 0).asDiagonal();
  covariance(2, 2) = std::nan("");
  const Eigen::Matrix3d rotated = rotate_axes(covariance, kQuarter);
  EXPECT_NEAR(rotated(0, 0), 1, 1e-12);
  EXPECT_NEAR(rotated(1, 1), 4, 1e-12);
  EXPECT_TRUE(std::isnan(rotated(2, 2)));
  EXPECT_TRUE(std::isnan(rotate_axes(Eigen::Matrix3d::Constant(std::nan("")), 1)(0, 0)));
}

TEST(RotatedAxes, AreComputedOnlyWhereSomethingDependsOnThem) {
  const std::vector<FeatureSpec> specs{
      {.name = "direction", .unit = "rad", .scale = Scale::direction, .summary = ""}};
  const Eigen::Matrix3d round = Eigen::Vector3d(4, 4, 9).asDiagonal();
  Eigen::Matrix3d oblique = round;
  oblique(0, 1) = oblique(1, 0) = 1;
  const FeatureSet unknown(1), known{{0.3, 0, 1}};
  EXPECT_FALSE(depends_on_axes(round, unknown, specs));
  EXPECT_FALSE(depends_on_axes(Eigen::Matrix3d::Constant(std::nan("")), unknown, specs));
  EXPECT_TRUE(depends_on_axes(oblique, unknown, specs));
  EXPECT_TRUE(depends_on_axes(Eigen::Matrix3d(Eigen::Vector3d(4, 1, 9).asDiagonal()), unknown, specs));
  EXPECT_TRUE(depends_on_axes(round, known, specs));

  int calls = 0;
  const auto rotation = [&] {
    ++calls;
    return kQuarter;
  };
  Observation seen;
  seen.covariance = round;
  seen.features = unknown;
  rotate_axes(seen, specs, rotation);
  EXPECT_EQ(calls, 0);
  seen.features = known;
  rotate_axes(seen, specs, rotation);
  EXPECT_EQ(calls, 1);
  EXPECT_NEAR(seen.features[0].value, 0.3 - kQuarter, 1e-12);
}

/// An axis to the northeast of a map whose x axis is turned to its y axis.
TEST(RotatedAxes, ChangeDirectionsAndAxesButNoOtherFeature) {
  const std::vector<FeatureSpec> specs{
      {.name = "radius", .unit = "m", .scale = Scale::ratio, .summary = ""},
      {.name = "axis", .unit = "rad", .scale = Scale::axis, .summary = ""},
      {.name = "direction", .unit = "rad", .scale = Scale::direction, .summary = ""},
      {.name = "unknown", .unit = "rad", .scale = Scale::axis, .summary = ""}};
  Landmark landmark;
  landmark.covariance = Eigen::Vector3d(4, 1, 9).asDiagonal();
  landmark.features = {{3, 0, 1}, {kQuarter / 2, 0, 1}, {-kQuarter, 0, 1}, {}};
  rotate_axes(landmark, specs, kQuarter);
  EXPECT_EQ(landmark.features[0].value, 3);
  EXPECT_NEAR(landmark.features[1].value, -kQuarter / 2, 1e-12);
  EXPECT_NEAR(std::abs(landmark.features[2].value), 2 * kQuarter, 1e-12);
  EXPECT_FALSE(landmark.features[3].known());
  EXPECT_NEAR(landmark.covariance(0, 0), 1, 1e-12);
  EXPECT_EQ(landmark.covariance(2, 2), 9);
}

}  // namespace
}  // namespace waymark::test
