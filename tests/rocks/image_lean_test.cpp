// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/image_lean.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "pipeline/rocks/find_rocks.hpp"
#include "tests/rocks/made_view.hpp"
#include "tests/rocks/rock_score.hpp"
namespace waymark::testing {
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

TEST(ImageLean, GrowsWithTheTangentOfTheAngleOfSight) {
  const auto lean = lean_of(looking_down(0));
  ASSERT_TRUE(lean);
  EXPECT_NEAR(lean->at(200, 200).norm(), 0, 1e-3);
  EXPECT_NEAR(lean->at(300, 200).x(), 0.25, 1e-3);  // tan = 100 / 400, away from the middle
  EXPECT_NEAR(lean->at(300, 200).y(), 0, 1e-3);
  EXPECT_NEAR(lean->at(200, 0).y(), -0.5, 1e-3);
}

TEST(ImageLean, IsThatOfATopSeenThroughTheCamera) {
  const PosedCamera camera = looking_down(0.3);
  const auto lean = lean_of(camera);
  ASSERT_TRUE(lean);
  for (const Eigen::Vector2d& ground : {Eigen::Vector2d{-30, -10}, {0, -40}, {20, 10}}) {
    const Eigen::Vector3d foot(ground.x(), ground.y(), 0);
    const auto from = project(camera, {foot}), to = project(camera, {foot + 0.1 * Eigen::Vector3d::UnitZ()});
    const auto east = project(camera, {foot + 0.1 * Eigen::Vector3d::UnitX()});
    ASSERT_TRUE(from && to && east);
    const double metre = (*east - *from).norm() / 0.1;  // pixels, across the line of sight
    // Lengths along the line of sight are shorter, so pixels of equal area are a little smaller; and the fit
    // is linear.
    EXPECT_NEAR((lean->at(from->x(), from->y()) - (*to - *from) / (0.1 * metre)).norm(), 0, 0.04);
  }
}

TEST(ImageLean, NothingIsToldOfImagesOfTheHorizon) {
  EXPECT_FALSE(lean_of(looking_down(1.2)));
  EXPECT_FALSE(lean_of(looking_down(2.5)));
}

TEST(ImageLean, ACameraWithTheLightSeesLessShadow) {
  const LightFrame light = LightFrame::of(Radians{0});  // sun at the right, shadows to the left
  EXPECT_NEAR(seen_shadow({-0.4, 0}, light, 1).along, 0.6, 1e-12);
  EXPECT_NEAR(seen_shadow({0.4, 0}, light, 1).along, 1.4, 1e-12);
  EXPECT_NEAR(seen_shadow({0.4, 0}, light, 0.25).along, 1.1, 1e-12);
  EXPECT_NEAR(seen_shadow({0, -0.3}, light, 1).aside, 0.3, 1e-12);
}

// Views through tilted cameras that nothing was fitted to: told how rocks lean, the detector places and
// measures them better than without.
TEST(ImageLean, ToldItPlacesRocksBetter) {
  RockScore told, untold;
  for (int k = 1000; k < 1004; ++k) {
    const MadeView view = leaning_view(k);
    RockSearch search{.sun_angle = Radians{view.sun_angle}, .sun_elevation = view.elevation};
    untold.add(view.image, find_rocks(view.image.pixels, search), view.sun_angle);
    search.lean = view.lean;
    told.add(view.image, find_rocks(view.image.pixels, search), view.sun_angle);
  }
  std::printf("leaning, told\n%sleaning, untold\n%s", told.text().c_str(), untold.text().c_str());
  EXPECT_GE(told.recall(1), 0.85);
  EXPECT_LE(std::abs(told.width(1).bias), 0.1);
  EXPECT_GT(told.ellipse_cover(), untold.ellipse_cover());
  EXPECT_LT(told.median_offset(2), untold.median_offset(2));
  EXPECT_LT(told.reach(2).sd, untold.reach(2).sd);
}

}  // namespace
}  // namespace waymark::testing
