// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/frames.hpp"
#include "core/units.hpp"

namespace waymark::test {
namespace {

template <class A, class B>
concept Composes = requires(A a, B b) {
  a* b;
};
template <class A, class B>
concept Adds = requires(A a, B b) {
  a + b;
};

static_assert(Composes<Pose<MapFrame, CameraFrame>, Point<CameraFrame>>);
static_assert(!Composes<Pose<MapFrame, CameraFrame>, Point<MapFrame>>);
static_assert(Composes<Pose<MapFrame, RobotFrame>, Pose<RobotFrame, CameraFrame>>);
static_assert(!Composes<Pose<RobotFrame, CameraFrame>, Pose<MapFrame, RobotFrame>>);
static_assert(Adds<Meters, Meters> && !Adds<Meters, Radians> && !Adds<Meters, double>);
static_assert(!std::is_convertible_v<double, Meters> && !std::is_convertible_v<Degrees, Radians>);

TEST(Units, ConvertByNameOnly) {
  EXPECT_DOUBLE_EQ(to_radians(180_deg).value, std::numbers::pi);
  EXPECT_DOUBLE_EQ(to_degrees(to_radians(33.5_deg)).value, 33.5);
  EXPECT_EQ((2 * 3_m - 1_m).value, 5);
  EXPECT_LT(1_m, 2_m);
  EXPECT_EQ(6_m / 3_m, 2);
}

TEST(Frames, APoseTurnsAndMovesAndItsInverseUndoesIt) {
  Pose<MapFrame, RobotFrame> map_from_robot;
  map_from_robot.transform =
      Eigen::Translation3d(10, 20, 1) * Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
  const Point<RobotFrame> ahead{{2, 0, 0}};
  EXPECT_TRUE((map_from_robot * ahead).xyz.isApprox(Eigen::Vector3d(10, 22, 1)));
  EXPECT_TRUE((map_from_robot.inverse() * (map_from_robot * ahead)).xyz.isApprox(ahead.xyz));
}

TEST(Frames, ADirectionIsNotMoved) {
  Pose<MapFrame, RobotFrame> map_from_robot;
  map_from_robot.transform = Eigen::Translation3d(10, 20, 1);
  EXPECT_TRUE((map_from_robot * Direction<RobotFrame>{}).unit.isApprox(Eigen::Vector3d::UnitX()));
}

}  // namespace
}  // namespace waymark::test
