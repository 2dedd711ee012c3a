// SPDX-License-Identifier: Apache-2.0
// Poses of a simulated landing whose camera has a rolling shutter, against the truth.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstdio>
#include <numbers>

#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/poses/solve_poses.hpp"
#include "testbed/landing/flight.hpp"
#include "testbed/landing/lit_terrain.hpp"
#include "testbed/render.hpp"
#include "testbed/scenario.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

// A parachute that swings at 85 m/s, then rockets; the rows of an image take a fifth of a second.
testbed::Scenario landing(int seed) {
  testbed::Scenario scenario = testbed::read_scenario(R"({
    "waymark_scenario": 1, "seed": )" + std::to_string(seed) +
                                                          R"(,
    "ground": {"cell": 0.8}, "relief": {"rms": 6, "max_wavelength": 300},
    "rocks": {"k": 0.1, "min_diameter": 1.5, "max_diameter": 6}, "albedo": {"variation": 0.2},
    "picture": {"readout_time": 0.2}, "camera": {"columns": 560, "rows": 560, "field_of_view": 55},
    "flights": [{"name": "landing", "path": "landing", "images": 14, "from_east": -60, "from_north": -40,
                 "from_altitude": 900, "to_east": 20, "to_north": 10, "to_altitude": 150,
                 "powered_altitude": 480, "crane_altitude": 151}]})",
                                                      "landing");
  return scenario;
}

struct MovingPictures {
  std::vector<testbed::Shot> shots = {};
  std::vector<ImageFeatures> features = {};
  std::vector<ImageToMatch> images = {};
  ImageMatches matches = {};
};

MovingPictures pictures_of(const testbed::Scenario& scenario) {
  MovingPictures out{.shots = testbed::plan_shots(scenario)};
  const testbed::Scene scene =
      testbed::make_scene(testbed::size_site(scenario, out.shots), static_cast<std::uint64_t>(scenario.seed));
  const testbed::LitTerrain ground(scene, scenario.exposure.sun);
  std::uint64_t noise = 0;
  for (const testbed::Shot& shot : out.shots) {
    Pixels image = testbed::render_view(scene, ground, testbed::camera_view(shot.view, shot.motion),
                                        scenario.exposure, ++noise);
    for (float& value : image.cells()) value = std::round(std::clamp(value, 0.F, 1.F) * 255);
    out.features.push_back(find_features(image, {}));
    out.images.push_back({.name = shot.name, .time = shot.time});
  }
  const LensGuess lens{.camera = out.shots[0].view.camera, .focal_sd = 0};
  out.matches = match_images(out.images, out.features, std::span(&lens, 1), {});
  return out;
}

struct ShutterError {
  double metres = 0, degrees = 0;  // RMS of the centres after a similarity fit, and of relative rotations
  double sigma0 = 0;
};

ShutterError shutter_error(const MovingPictures& pictures, double readout_time) {
  const std::size_t n = pictures.shots.size();
  ImageMatches matches = pictures.matches;
  matches.lenses[0].readout_time = readout_time;
  SolvedPoses solved = solve_poses(pictures.images, pictures.features, matches, {});
  ShutterError error;
  if (solved.components.empty() || solved.components[0].posed < n) {
    ADD_FAILURE() << "not all images are posed";
    return error;
  }
  Reconstruction& scene = solved.components[0].scene;
  error.sigma0 = adjust(scene, {}).sigma0;
  const auto count = static_cast<Eigen::Index>(n);
  Eigen::Matrix3Xd from(3, count), to(3, count);
  for (std::size_t i = 0; i < n; ++i) {
    from.col(static_cast<Eigen::Index>(i)) = scene.images[i].world_from_camera->translation();
    to.col(static_cast<Eigen::Index>(i)) = pictures.shots[i].view.centre().xyz;
  }
  const Eigen::Matrix4d fit = Eigen::umeyama(from, to, true);
  error.metres =
      std::sqrt(((fit * from.colwise().homogeneous()).topRows<3>() - to).squaredNorm() / double(n));
  const auto true_rotation = [&](std::size_t i) {
    return Eigen::Matrix3d(pictures.shots[i].view.grid_from_camera.transform.linear());
  };
  for (std::size_t i = 1; i < n; ++i) {
    const Eigen::Matrix3d found = scene.images[i - 1].world_from_camera->linear().transpose() *
                                  scene.images[i].world_from_camera->linear();
    const Eigen::Matrix3d truth = true_rotation(i - 1).transpose() * true_rotation(i);
    error.degrees += std::pow(Eigen::AngleAxisd(Eigen::Matrix3d(found.transpose() * truth)).angle(), 2);
  }
  error.degrees = std::sqrt(error.degrees / double(n - 1)) / kDegree;
  return error;
}

TEST(RollingShutter, PosesOfALandingAreThoseOfTheTruth) {
  for (const int seed : {1, 3}) {
    const MovingPictures pictures = pictures_of(landing(seed));
    const ShutterError global = shutter_error(pictures, 0), rolling = shutter_error(pictures, 0.2);
    std::printf(
        "seed %d: global shutter %.3f m, %.4f deg, sigma0 %.2f; rolling %.3f m, %.4f deg, sigma0 %.2f\n",
        seed, global.metres, global.degrees, global.sigma0, rolling.metres, rolling.degrees, rolling.sigma0);
    EXPECT_LT(rolling.metres, 0.5 * global.metres) << "seed " << seed;
    EXPECT_LT(rolling.degrees, 0.5 * global.degrees) << "seed " << seed;
    EXPECT_LT(rolling.sigma0, global.sigma0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace waymark::test
