// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "testbed/render.hpp"
#include "tests/pipeline/fusion/made_landing.hpp"
namespace waymark::test {
using namespace pipeline;

/// Returns a small descent of three images with a coarse DEM.
inline testbed::Scenario descent(std::int64_t seed) {
  testbed::Scenario scenario;
  scenario.seed = seed;
  scenario.ground.width = scenario.ground.height = 0;
  scenario.ground.cell = 0.8;
  scenario.ground.rocks.k = 0.03;
  scenario.lens.columns = scenario.lens.rows = 320;
  scenario.flights.front().images = 3;
  scenario.flights.front().from_altitude = 260, scenario.flights.front().to_altitude = 160;
  scenario.flights.front().from_east = scenario.flights.front().from_north = -30;
  scenario.flights.front().to_east = scenario.flights.front().to_north = 20;
  scenario.pose_errors = {0.4, Degrees{0.05}};
  scenario.dem = {.cell = 1.6, .height_sd = 0.1, .correlation = 10};
  return scenario;
}

/// Rendered images of a descent, with given and true poses.
struct MadeImages {
  Terrain dem;
  std::vector<ImageView> given;
  std::vector<PosedCamera> truth;
  std::vector<Pixels> pixels;
};

/// Renders all images of a scenario.
inline MadeImages made_images(testbed::Scenario scenario) {
  const std::vector<testbed::Shot> shots = testbed::plan_shots(scenario);
  scenario.ground = testbed::size_site(scenario, shots);
  const testbed::Scene scene =
      testbed::make_scene(scenario.ground, static_cast<std::uint64_t>(scenario.seed));
  MadeImages made{given_terrain(scenario, scene), {}, {}, {}};
  for (const testbed::Shot& shot : shots) {
    ImageInfo info;
    info.name = shot.name;
    info.columns = shot.view.camera.columns, info.rows = shot.view.camera.rows;
    info.view = shot.view;
    info.view->grid_from_camera = shot.reported;
    info.sun = scenario.exposure.sun;
    made.given.push_back(make_image_view(info));
    compute_footprint(made.given.back(), made.dem, 1);
    made.truth.push_back(shot.view);
    made.pixels.push_back(
        testbed::render_view(scene, testbed::camera_view(shot.view), scenario.exposure, made.pixels.size()));
  }
  return made;
}

}  // namespace waymark::test
