// SPDX-License-Identifier: Apache-2.0
#include "testbed/render.hpp"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "testbed/landing/lit_terrain.hpp"
#include "testbed/landing/rock_field.hpp"
#include "testbed/sensor.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

SiteModel bare_ground() {
  SiteModel ground;
  ground.width = ground.height = 40;
  ground.relief.rms = 0;
  ground.craters.density = 0;
  ground.craters.clusters = 0;
  ground.rocks.k = 0;
  ground.dunes.cover = 0;
  ground.albedo = {.mean = 0.3, .variation = 0, .longest = 100, .rays = 0};
  return ground;
}

Exposure plain_light(double azimuth, double elevation) {
  return {.sun = {{azimuth}, {elevation}},
          .photometry = Photometry::lambert,
          .skylight = 0,
          .haze = 0,
          .psf_sd = 0,
          .read_noise = 0,
          .shot_noise = 0,
          .level = 0,
          .contrast = 1,
          .samples = 4};
}

Scene with_rock(RockShape shape, double width, double height) {
  Scene scene = make_scene(bare_ground(), 1);
  Random random(1);
  RockSolid solid = make_rock(shape, width, height, random);
  solid.brightness = 1;
  scene.solids.push_back(solid);
  scene.rocks.push_back({Eigen::Vector3d::Zero(), width, height, shape});
  return scene;
}

PosedCamera looking_down(double altitude) {
  PosedCamera view;
  view.camera = {.columns = 200, .rows = 200, .fx = 400, .fy = 400, .cx = 99.5, .cy = 99.5};
  view.grid_from_camera.transform.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  view.grid_from_camera.transform.translation().z() = altitude;
  return view;
}

TEST(Render, LevelGroundIsAsBrightAsTheLawSays) {
  const Scene scene = make_scene(bare_ground(), 1);
  const View view = map_view(scene, 0.5, 40, 40);
  EXPECT_NEAR(double(render_view(scene, view, plain_light(90, 30), 1)(20, 20)), 0.3 * 0.5, 1e-6);
  Exposure moon = plain_light(90, 30);
  moon.photometry = Photometry::lommel_seeliger;
  EXPECT_NEAR(double(render_view(scene, view, moon, 1)(20, 20)), 0.3 * 2 * 0.5 / 1.5, 1e-6);
  moon.skylight = 0.1;
  EXPECT_NEAR(double(render_view(scene, view, moon, 1)(20, 20)), 0.3 * (2 * 0.5 / 1.5 + 0.1), 1e-6);
}

TEST(Render, ARockCastsAShadowOfItsLength) {
  const double height = 2, elevation = 35;
  const Scene scene = with_rock(RockShape::cylinder, 1.5, height);
  for (const double azimuth : {0.0, 90.0, 225.0}) {
    const double gsd = 0.05;
    const View view = map_view(scene, gsd, 400, 400);
    const Pixels image = render_view(scene, view, plain_light(azimuth, elevation), 1);
    const double away = (azimuth + 180) * std::numbers::pi / 180;  // where the shadow points
    double length = 0;
    for (double s = 0; s < 8; s += gsd / 2) {
      const double x = s * std::sin(away), y = s * std::cos(away);
      if (image(std::lround((x - view.x0) / gsd), std::lround((view.y0 - y) / gsd)) == 0) length = s;
    }
    const double edge = length - height / std::tan(elevation * std::numbers::pi / 180);
    EXPECT_GT(edge, 0.5) << azimuth;  // the far rim of the top: half the width, which lies between
    EXPECT_LT(edge, 1.0) << azimuth;  // 0.5 sqrt(0.7) x 1.5 and 0.5 / sqrt(0.7) x 1.5
  }
}

TEST(Render, ShadowsOfTheGroundAreThoseOfRays) {
  SiteModel ground = bare_ground();
  ground.relief = {.rms = 4, .longest = 40, .hurst = 0.8, .roughness = 0.3};
  const Scene scene = make_scene(ground, 3);
  for (const double azimuth : {10.0, 100.0, 190.0, 305.0}) {
    const Sun sun{{azimuth}, {20}};
    const LitTerrain lit(scene, sun);
    Random random(1);
    int same = 0, dark = 0;
    constexpr int kPoints = 4000;
    for (int i = 0; i < kPoints; ++i) {
      const double x = random.uniform(-18, 18), y = random.uniform(-18, 18), z = *scene.terrain.height(x, y);
      const bool shadow = scene.terrain.in_shadow({{x, y, z}}, sun_direction(sun));
      same += shadow == (z < lit.shadow_height(x, y)), dark += shadow;
    }
    EXPECT_GT(dark, kPoints / 20) << azimuth;
    EXPECT_GT(same, kPoints * 96 / 100) << azimuth;  // the rest lies within a cell of an edge
  }
}

TEST(Render, CameraAndMapAgree) {
  const Scene scene = with_rock(RockShape::ellipsoid, 4, 2);
  const PosedCamera camera = looking_down(200);  // 0.5 m pixels
  const Pixels from_camera = render_view(scene, camera_view(camera), plain_light(60, 40), 1);
  const Pixels from_map = render_view(scene, map_view(scene, 0.5, 60, 60), plain_light(60, 40), 1);
  // The middle of both is the middle of the site; the rock's top is nearer, by 1 %.
  double off = 0;
  for (std::int64_t j = 10; j < 50; ++j)
    for (std::int64_t i = 10; i < 50; ++i)
      off += std::abs(double(from_map(i, j)) - double(from_camera(i + 70, j + 70)));
  EXPECT_LT(off / 1600, 0.003);
}

PosedCamera moved(PosedCamera camera, const CameraMotion& motion, double seconds) {
  Eigen::Isometry3d& pose = camera.grid_from_camera.transform;
  pose.translation() += seconds * motion.velocity;
  const double angle = seconds * motion.spin.norm();
  if (angle != 0) pose.linear() = Eigen::AngleAxisd(angle, motion.spin.normalized()) * pose.linear();
  return camera;
}

// The slow twin takes one image of a standing camera for each row.
TEST(Render, ARollingShutterTakesEachRowAtItsTime) {
  const Scene scene = with_rock(RockShape::ellipsoid, 4, 2);
  const PosedCamera camera = looking_down(70);
  Exposure exposure = plain_light(60, 40);
  exposure.samples = 1;
  const CameraMotion motion{.velocity = {4, -2, -10}, .spin = {0.05, 0.1, -0.2}};
  exposure.readout_time = 2;
  const Pixels rolling = render_view(scene, camera_view(camera, motion), exposure, 1);
  const Pixels global = render_view(scene, camera_view(camera), exposure, 1);
  double worst = 0, changed = 0;
  for (const std::int64_t row : {60, 92, 96, 104, 108, 140}) {
    const double t = 2 * (double(row) / 199 - 0.5);
    const Pixels standing = render_view(scene, camera_view(moved(camera, motion, t)), plain_light(60, 40), 1);
    double off = 0;
    for (std::int64_t i = 40; i < 160; ++i) {
      off += std::abs(double(rolling(i, row)) - double(standing(i, row))) / 120;
      changed = std::max(changed, std::abs(double(rolling(i, row)) - double(global(i, row))));
    }
    worst = std::max(worst, off);
  }
  EXPECT_LT(worst, 0.003) << "of a brightness of 0.19; the standing images are supersampled";
  EXPECT_GT(changed, 0.1);
}

TEST(Render, MotionBlursAsTheMeanOfItsInstants) {
  const Scene scene = with_rock(RockShape::ellipsoid, 4, 2);
  const PosedCamera camera = looking_down(70);
  Exposure exposure = plain_light(60, 40);
  const CameraMotion motion{.velocity = {20, 0, 0}, .spin = {0, 0, 0.3}};
  exposure.exposure_time = 0.1;
  const Pixels blurred = render_view(scene, camera_view(camera, motion), exposure, 1);
  Pixels mean(200, 200, 0);
  constexpr int kInstants = 48;
  for (int k = 0; k < kInstants; ++k) {
    const double t = 0.1 * ((k + 0.5) / kInstants - 0.5);
    const Pixels still = render_view(scene, camera_view(moved(camera, motion, t)), plain_light(60, 40), 1);
    for (std::int64_t j = 0; j < 200; ++j)
      for (std::int64_t i = 0; i < 200; ++i) mean(i, j) += still(i, j) / kInstants;
  }
  double off = 0, unlike = 0;
  const Pixels sharp = render_view(scene, camera_view(camera), plain_light(60, 40), 1);
  for (std::int64_t j = 60; j < 140; ++j)
    for (std::int64_t i = 60; i < 140; ++i) {
      off += std::abs(double(blurred(i, j)) - double(mean(i, j))) / 6400;
      unlike += std::abs(double(sharp(i, j)) - double(mean(i, j))) / 6400;
    }
  EXPECT_LT(off, 0.25 * unlike);
}

// Through dust of optical depth 1 the contrast of the ground falls to 1 / e.
TEST(Render, DustHidesTheGround) {
  const Scene scene = with_rock(RockShape::ellipsoid, 4, 2);
  const Exposure exposure = plain_light(60, 40);
  View view = camera_view(looking_down(70));
  const Pixels clear = render_view(scene, view, exposure, 1);
  view.dust = {.depth = 1, .radius = 1e6, .centre = {0, 0}, .seed = 3};
  const Pixels dusty = render_view(scene, view, exposure, 1);
  const auto contrast = [](const Pixels& image) {
    float low = 1, high = 0;
    for (std::int64_t j = 80; j < 120; ++j)
      for (std::int64_t i = 80; i < 120; ++i)
        low = std::min(low, image(i, j)), high = std::max(high, image(i, j));
    return double(high - low);
  };
  // Over such a radius the billows are one value for the image.
  const double depth = dust_depth(view.dust, 0, 0);
  EXPECT_GT(depth, 0.3);
  EXPECT_NEAR(contrast(dusty) / contrast(clear), std::exp(-depth), 0.05);
  EXPECT_EQ(dust_depth({}, 0, 0), 0);
}

// A disc of 2 m radius 35 m below a camera at 70 m covers a known number of pixels, and casts a shadow.
TEST(Render, AShieldCoversItsDisc) {
  const Scene scene = make_scene(bare_ground(), 1);
  const PosedCamera camera = looking_down(70);
  const Exposure exposure = plain_light(60, 75);  // the shadow falls 9 m beside the nadir
  View view = camera_view(camera);
  const Pixels clear = render_view(scene, view, exposure, 1);
  view.shield = {.radius = 2, .centre = camera.centre().xyz - Eigen::Vector3d(0, 0, 35)};
  const Pixels shown = render_view(scene, view, exposure, 1);
  double brighter = 0, darker = 0;
  for (std::int64_t j = 0; j < shown.rows(); ++j)
    for (std::int64_t i = 0; i < shown.columns(); ++i) {
      const double change = double(shown(i, j)) / double(clear(i, j));
      if (change > 1.3) ++brighter;
      if (change < 0.7) ++darker;
    }
  const double pixels = std::numbers::pi * std::pow(2 * camera.camera.fx / 35, 2);
  EXPECT_NEAR(brighter, pixels, 0.05 * pixels);
  const double shadow = std::numbers::pi * std::pow(2 * camera.camera.fx / 70, 2);
  EXPECT_NEAR(darker, shadow, 0.1 * shadow);
}

TEST(Render, PastTheGroundIsNoData) {
  const Scene scene = make_scene(bare_ground(), 1);
  const Pixels image = render_view(scene, map_view(scene, 0.5, 100, 20), plain_light(60, 40), 1);
  EXPECT_TRUE(std::isnan(image(0, 10)));
  EXPECT_FALSE(std::isnan(image(50, 10)));
}

TEST(Render, IsTheSameBitForBitOnOneThread) {
  SiteModel ground;
  ground.width = ground.height = 60;
  ground.craters.max_diameter = 20;
  const Scene scene = make_scene(ground, 2);
  const View view = map_view(scene, 0.25, 200, 200);
  const Pixels many = render_view(scene, view, Exposure{}, 9);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(many, render_view(scene, view, Exposure{}, 9));
  EXPECT_NE(many, render_view(scene, view, Exposure{}, 10));
}

TEST(Render, RefusesTheNight) {
  const Scene scene = make_scene(bare_ground(), 1);
  try {
    render_view(scene, map_view(scene, 1, 10, 10), plain_light(90, -5), 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem(), "the sun is below the horizon: nothing to see");
  }
}

TEST(Sensor, NoiseAndExposureAreAsAsked) {
  Pixels light(300, 300, 0.1F);
  Exposure exposure;
  exposure.read_noise = 0.01, exposure.shot_noise = 0.02, exposure.level = 0.4;
  const Pixels image = apply_sensor(light, exposure, 0.1, 4);
  double sum = 0, squares = 0;
  for (const float p : image.cells()) sum += double(p), squares += double(p) * double(p);
  const double mean = sum / 9e4, sd = std::sqrt(squares / 9e4 - mean * mean);
  EXPECT_NEAR(mean, 0.4, 5e-4);
  EXPECT_NEAR(sd, std::sqrt(0.0001 + 0.0004 * 0.4), 3e-4);
}

TEST(Sensor, BlurKeepsTheLightAndHasItsWidth) {
  Pixels point(41, 41, 0.0F);
  point(20, 20) = 1;
  const Pixels image = gaussian_blur(point, 1.5);
  double sum = 0, second = 0;
  for (std::int64_t j = 0; j < 41; ++j)
    for (std::int64_t i = 0; i < 41; ++i)
      sum += double(image(i, j)), second += double(image(i, j)) * double((i - 20) * (i - 20));
  EXPECT_NEAR(sum, 1, 1e-4);
  EXPECT_NEAR(second, 1.5 * 1.5 + 1.0 / 12, 0.02);  // and the width of the pixel
}

TEST(Outline, OfACraterIsItsEllipse) {
  const Scene scene = make_scene(bare_ground(), 1);
  const View map = map_view(scene, 0.1, 400, 400);
  const TrueCrater crater{
      .position = {3, -2, 0}, .major = 8, .minor = 6, .orientation = 30 * kRadiansPerDegree};
  const auto shape = image_outline(map, crater);
  ASSERT_TRUE(shape);
  EXPECT_NEAR(shape->x, 199.5 + 30, 1e-6);
  EXPECT_NEAR(shape->y, 199.5 + 20, 1e-6);
  EXPECT_NEAR(shape->major, 80, 0.01);
  EXPECT_NEAR(shape->minor, 60, 0.01);
  EXPECT_NEAR(shape->angle, -60 * kRadiansPerDegree, 1e-6);  // 30 deg east of north points up and right
  EXPECT_FALSE(image_outline(map, TrueCrater{.position = {19, 0, 0}, .major = 8, .minor = 8}));

  const auto seen = image_outline(camera_view(looking_down(100)), crater);  // 0.25 m pixels
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->x, 99.5 + 12, 1e-6);
  EXPECT_NEAR(seen->major, 32, 0.01);
}

TEST(Outline, TheSunIsTowardsTheLitSideOfTheImage) {
  const Scene scene = make_scene(bare_ground(), 1);
  const View map = map_view(scene, 0.1, 10, 10);
  EXPECT_NEAR(image_sun_angle(map, {{90}, {30}}), 0, 1e-12);                     // east: right
  EXPECT_NEAR(image_sun_angle(map, {{0}, {30}}), -std::numbers::pi / 2, 1e-12);  // north: up
  EXPECT_NEAR(image_sun_angle(camera_view(looking_down(50)), {{180}, {30}}), std::numbers::pi / 2, 1e-9);
}

}  // namespace
}  // namespace waymark::test
