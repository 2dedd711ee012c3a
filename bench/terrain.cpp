// SPDX-License-Identifier: Apache-2.0
// Rays onto a rough fractal terrain of 4097^2 heights, one thread, and whole pictures on all threads.
#include <benchmark/benchmark.h>

#include <cmath>

#include "core/random.hpp"
#include "geo/terrain.hpp"
#include "testbed/landing/lit_terrain.hpp"
#include "testbed/noise.hpp"
#include "testbed/render.hpp"

namespace waymark::bench {
namespace {

const Terrain& rough_terrain() {
  static const Terrain terrain(
      testbed::fractal_grid({.longest = 1000, .shortest = 2, .amplitude = 30, .hurst = 0.8, .seed = 1},
                            {4097, 4097, 0, 0, 1}),
      0, 0, 1, 1);
  return terrain;
}

void cast_rays(benchmark::State& state, bool coherent, double off_nadir) {
  const Terrain& terrain = rough_terrain();
  Random random(1);
  const double tangent = std::tan(to_radians(Degrees{off_nadir}).value);
  std::int64_t cast = 0;
  for (auto _ : state) {
    const double x = coherent ? 1500 + double(cast % 1000) : random.uniform(1000, 3000);
    const double y = coherent ? -1500 - double(cast / 1000 % 1000) : random.uniform(-3000, -1000);
    const double turn = coherent ? 0.7 : random.uniform(0, 6.28);
    const Eigen::Vector3d down =
        Eigen::Vector3d(tangent * std::cos(turn), tangent * std::sin(turn), -1).normalized();
    benchmark::DoNotOptimize(terrain.cast({{{x, y, 400}}, {down}}));
    ++cast;
  }
  state.SetItemsProcessed(cast);
}
BENCHMARK_CAPTURE(cast_rays, nadir_coherent, true, 0);
BENCHMARK_CAPTURE(cast_rays, nadir_random, false, 0);
BENCHMARK_CAPTURE(cast_rays, oblique_60_coherent, true, 60);
BENCHMARK_CAPTURE(cast_rays, oblique_60_random, false, 60);

void build_terrain(benchmark::State& state) {
  const Grid<float> heights = rough_terrain().heights();
  for (auto _ : state) benchmark::DoNotOptimize(Terrain(heights, 0, 0, 1, 1));
  state.SetItemsProcessed(state.iterations() * heights.columns() * heights.rows());
}
BENCHMARK(build_terrain)->Unit(benchmark::kMillisecond);

const testbed::Scene& site() {
  static const testbed::Scene scene = [] {
    testbed::SiteModel ground;
    ground.width = ground.height = 800;
    ground.cell = 0.4;
    return testbed::make_scene(ground, 1);
  }();
  return scene;
}

void make_ground(benchmark::State& state) {
  testbed::SiteModel ground;
  ground.width = ground.height = 800;
  ground.cell = 0.4;
  for (auto _ : state) benchmark::DoNotOptimize(testbed::make_scene(ground, 1));
}
BENCHMARK(make_ground)->Unit(benchmark::kMillisecond)->UseRealTime();

// 1 Mpx of descent image: rays, shading, cast shadows, rocks, point spread, noise.
void render_descent(benchmark::State& state) {
  const testbed::Exposure exposure;
  const testbed::LitTerrain ground(site(), exposure.sun);
  PosedCamera camera;
  camera.camera = {.columns = 1000, .rows = 1000, .fx = 1000, .fy = 1000, .cx = 499.5, .cy = 499.5};
  camera.grid_from_camera.transform.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  camera.grid_from_camera.transform.translation().z() = double(state.range(0));
  for (auto _ : state)
    benchmark::DoNotOptimize(testbed::render_view(site(), ground, testbed::camera_view(camera), exposure, 1));
  state.SetItemsProcessed(state.iterations() * 1000 * 1000);
}
BENCHMARK(render_descent)->Arg(500)->Arg(200)->Arg(60)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
