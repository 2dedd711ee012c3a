// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/projection/image_view_codec.hpp"
#include "tests/support/round_trip.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

TEST(FusionCodecs, Detections) {
  Detection d;
  d.type = 3;
  d.outline = {10.5, 20.25, 8, 6, -0.7};
  d.covariance << 0.1, 0.02, 0.02, 0.3;
  d.shadow_reach = MeasuredValue{7.5, 0.25};
  d.reach_slope_response = 0.4;
  d.diameter_slope_response = 0.2;
  d.confidence = 0.8;
  const std::vector<Detection> all{d, Detection{}};
  expect_round_trip(all);
  EXPECT_EQ(Codec<std::vector<Detection>>::decode(Codec<std::vector<Detection>>::encode(all)), all);
}

TEST(FusionCodecs, Observations) {
  Observation o;
  o.type = 1;
  o.landmark_uid = "ro-1";
  o.source = "descent_0007.png";
  o.pixel = Eigen::Vector2d(3, 4);
  o.position = {{1, 2, 3}};
  o.covariance << 1, 2, 3, 2, 5, 6, 3, 6, 9;
  o.features = {{1, 2, 3}, {}};
  o.rejected = "looks at the sky";
  expect_round_trip(std::vector<Observation>{o, Observation{}});
  const auto back =
      Codec<std::vector<Observation>>::decode(Codec<std::vector<Observation>>::encode({o})).front();
  EXPECT_EQ(back.source, o.source);
  EXPECT_EQ(back.pixel, o.pixel);
  EXPECT_EQ(back.covariance, o.covariance);
  EXPECT_EQ(back.rejected, o.rejected);
}

TEST(FusionCodecs, ImageViews) {
  ImageView image;
  image.name = "descent_0007.png";
  image.columns = 1024, image.rows = 768;
  image.view.emplace();
  image.view->camera.fx = 900;
  image.view->camera.lens = Camera::Lens::fisheye;
  image.view->grid_from_camera.transform.translation() = Eigen::Vector3d(1, 2, 3);
  image.view->motion = ShutterMotion{.shift = {0.5, 0, -1}, .turn = {0, 0.01, 0.02}};
  image.dem_constraint.emplace();
  image.dem_constraint->information(5, 1) = 2;
  image.dem_constraint->information_vector(4) = 3;
  image.dem_shift.emplace();
  image.dem_shift->metres = Eigen::Vector2d(3, -2);
  image.dem_shift->cell = 1.5;
  image.view->covariance(5, 0) = 0.25;
  image.sun = Sun{{120}, {35}, {0.5}};
  image.taken_utc = "2026-11-21T10:00:00Z";
  image.footprint = {{{0, 0}, {1, 0}, {0, 1}, {0, 0}}, {}};
  image.area = 0.5, image.gsd = 0.1;
  ImageView ortho;
  ortho.ortho = OrthoGrid{5, 6, 0.5, -0.5};
  expect_round_trip(image);
  expect_round_trip(std::vector<ImageView>{image, ortho});
  const ImageView back = Codec<ImageView>::decode(Codec<ImageView>::encode(image));
  EXPECT_EQ(back.view->camera, image.view->camera);
  EXPECT_EQ(back.view->covariance, image.view->covariance);
  EXPECT_EQ(back.view->motion, image.view->motion);
  EXPECT_EQ(back.sun, image.sun);
  ASSERT_TRUE(back.dem_shift);
  EXPECT_EQ(back.dem_shift->metres, image.dem_shift->metres);
  EXPECT_EQ(back.dem_shift->cell, image.dem_shift->cell);
  EXPECT_EQ(back.footprint, image.footprint);
}

TEST(FusionCodecs, CamerasAreToldAsJson) {
  ImageView image;
  EXPECT_EQ(camera_json(image), "{}");
  image.ortho = OrthoGrid{5, 6, 0.5, -0.5};
  EXPECT_EQ(camera_json(image), R"({"first_pixel":[5.0,6.0],"model":"ortho","step":[0.5,-0.5]})");
  image.view.emplace();
  EXPECT_NE(camera_json(image).find(R"("model":"brown")"), std::string::npos);
}

}  // namespace
}  // namespace waymark::test
