// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/relief_displacement.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "pipeline/rocks/find_rocks.hpp"
#include "pipeline/rocks/shadow_shape.hpp"
#include "tests/pipeline/rocks/rock_score.hpp"
#include "workflows/training/rock_views.hpp"
namespace waymark::test {
using namespace pipeline;
using namespace workflows;
namespace {

PosedCamera looking_down(double tilt) {
  PosedCamera camera;
  camera.camera = {.columns = 401, .rows = 401, .fx = 400, .fy = 400, .cx = 200, .cy = 200};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(3.141592653589793 - tilt, Eigen::Vector3d::UnitX()).toRotationMatrix();
  pose.translation().z() = 100;
  camera.grid_from_camera.transform = pose;
  return camera;
}

TEST(ReliefDisplacement, GrowsWithTheTangentOfTheAngleOfSight) {
  const auto displacement = relief_displacement_of(looking_down(0));
  ASSERT_TRUE(displacement);
  EXPECT_NEAR(displacement->at(200, 200).norm(), 0, 1e-3);
  EXPECT_NEAR(displacement->at(300, 200).x(), 0.25, 1e-3);  // tan = 100 / 400, away from the middle
  EXPECT_NEAR(displacement->at(300, 200).y(), 0, 1e-3);
  EXPECT_NEAR(displacement->at(200, 0).y(), -0.5, 1e-3);
}

TEST(ReliefDisplacement, IsThatOfATopSeenThroughTheCamera) {
  const PosedCamera camera = looking_down(0.3);
  const auto displacement = relief_displacement_of(camera);
  ASSERT_TRUE(displacement);
  for (const Eigen::Vector2d& ground : {Eigen::Vector2d{-30, -10}, {0, -40}, {20, 10}}) {
    const Eigen::Vector3d foot(ground.x(), ground.y(), 0);
    const auto from = project(camera, {foot}), to = project(camera, {foot + 0.1 * Eigen::Vector3d::UnitZ()});
    const auto east = project(camera, {foot + 0.1 * Eigen::Vector3d::UnitX()});
    ASSERT_TRUE(from && to && east);
    const double metre = (*east - *from).norm() / 0.1;  // pixels, across the line of sight
    // Lengths along the line of sight are shorter, so pixels of equal area are a little smaller; and the fit
    // is linear.
    EXPECT_NEAR((displacement->at(from->x(), from->y()) - (*to - *from) / (0.1 * metre)).norm(), 0, 0.04);
  }
}

TEST(ReliefDisplacement, NothingIsToldOfImagesOfTheHorizon) {
  EXPECT_FALSE(relief_displacement_of(looking_down(1.2)));
  EXPECT_FALSE(relief_displacement_of(looking_down(2.5)));
}

TEST(ReliefDisplacement, ACameraWithTheLightSeesLessShadow) {
  const LightFrame light = LightFrame::of(Radians{0});  // sun at the right, shadows to the left
  EXPECT_NEAR(visible_shadow({-0.4, 0}, light, 1).along, 0.6, 1e-12);
  EXPECT_NEAR(visible_shadow({0.4, 0}, light, 1).along, 1.4, 1e-12);
  EXPECT_NEAR(visible_shadow({0.4, 0}, light, 0.25).along, 1.1, 1e-12);
  EXPECT_NEAR(visible_shadow({0, -0.3}, light, 1).deviation, 0.3, 1e-12);
}

// Held-out views through tilted cameras: with the relief displacement the detector locates and measures rocks
// better than without.
TEST(ReliefDisplacement, ToldItPlacesRocksBetter) {
  RockScore known, unknown;
  for (int k = 1000; k < 1004; ++k) {
    const SyntheticView view = leaning_view(k);
    RockSearch search{.sun_angle = Radians{view.sun_angle}, .sun_elevation = view.elevation};
    unknown.add(view.image, find_rocks(view.image.pixels, search), view.sun_angle);
    search.displacement = view.displacement;
    known.add(view.image, find_rocks(view.image.pixels, search), view.sun_angle);
  }
  std::printf("leaning, known\n%sleaning, unknown\n%s", known.text().c_str(), unknown.text().c_str());
  EXPECT_GE(known.recall(1), 0.85);
  EXPECT_LE(std::abs(known.width(1).bias), 0.1);
  EXPECT_GT(known.ellipse_cover(), unknown.ellipse_cover());
  EXPECT_LT(known.median_offset(2), unknown.median_offset(2));
  EXPECT_LT(known.reach(2).sd, unknown.reach(2).sd);
}

}  // namespace
}  // namespace waymark::test
