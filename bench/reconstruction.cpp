// SPDX-License-Identifier: Apache-2.0
// Adjustment of an aerial block with self-calibration: the last solution with its covariances. One thread.
#include <benchmark/benchmark.h>

#include <cmath>

#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/adjustment/place_on_image.hpp"
#include "pipeline/reconstruction/adjustment/triangulate.hpp"
#include "tests/pipeline/reconstruction/moving_scene.hpp"

namespace waymark::bench {
using namespace test;
namespace {

/// Some 100 tie points per image, each in about nine images.
MadeSceneOptions block(int side) {
  return {.seed = 1, .columns = side, .rows = side, .tilt = 0.1, .points = 100 * side * side};
}

void adjust_block(benchmark::State& state) {
  const MadeScene made = made_scene(block(static_cast<int>(state.range(0))));
  const pipeline::Observations seen{.positions = made_positions(made.truth, 0.3, 1)};
  pipeline::AdjustmentOptions options;
  options.robust = state.range(1) != 0;
  options.free_lens_parameters = {{"f", "k1"}};
  double marks = 0;
  for (const pipeline::TiePoint& point : made.start.points) marks += static_cast<double>(point.marks.size());
  for (auto _ : state) {
    pipeline::Reconstruction scene = made.start;
    benchmark::DoNotOptimize(pipeline::adjust(scene, seen, options).sigma0);
  }
  state.counters["images"] = static_cast<double>(made.start.images.size());
  state.counters["marks"] = marks;
}
BENCHMARK(adjust_block)
    ->ArgNames({"side", "robust"})
    ->Args({3, 0})
    ->Args({6, 0})
    ->Args({6, 1})
    ->Args({10, 0})
    ->Unit(benchmark::kMillisecond);

// A flight of 24 images with a rolling shutter: 0 as if it were global, 1 with six more unknowns per image.
void adjust_moving(benchmark::State& state) {
  MadeScene made = moving_scene({.points = 1200});
  if (state.range(0) == 0) made.start.lenses[0].readout_time = 0;
  const pipeline::Observations seen{.positions = made_positions(made.truth, 0.1, 1)};
  pipeline::AdjustmentOptions options;
  options.robust = false;
  for (auto _ : state) {
    pipeline::Reconstruction scene = made.start;
    benchmark::DoNotOptimize(pipeline::adjust(scene, seen, options).sigma0);
  }
}
BENCHMARK(adjust_moving)->ArgName("rolling")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void triangulate_points(benchmark::State& state) {
  const MadeScene made = made_scene(block(4));
  for (auto _ : state)
    for (const pipeline::TiePoint& point : made.truth.points)
      benchmark::DoNotOptimize(pipeline::triangulate(made.truth, point.marks));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(made.truth.points.size()));
}
BENCHMARK(triangulate_points)->Unit(benchmark::kMillisecond);

// A mosaic in an orthophoto of so many cells across, over the default range of scales. All threads.
void place_in_image(benchmark::State& state) {
  const std::int64_t cells = state.range(0);
  const auto brightness = [](double x, double y) {
    return 100 + 20 * std::sin(x / 7 + 3 * std::sin(y / 31)) + 15 * std::sin(y / 11 + 2 * std::cos(x / 43)) +
           25 * std::sin((x + y) / 97);
  };
  pipeline::LevelImage map{.grid = {.west = 0, .north = double(cells), .columns = cells, .rows = cells}};
  map.brightness = Grid<float>(cells, cells);
  pipeline::LevelImage mosaic{.grid = {.west = -80, .north = 80, .columns = 160, .rows = 160}};
  mosaic.brightness = Grid<float>(160, 160);
  for (std::int64_t r = 0; r < cells; ++r)
    for (std::int64_t c = 0; c < cells; ++c)
      map.brightness(c, r) = static_cast<float>(brightness(double(c), double(r)));
  const double scale = double(cells) / 3 / 160, turn = 0.7;
  for (std::int64_t r = 0; r < 160; ++r)
    for (std::int64_t c = 0; c < 160; ++c) {
      const double x = scale * (double(c) - 80), y = scale * (double(r) - 80);
      mosaic.brightness(c, r) =
          static_cast<float>(brightness(double(cells) / 2 + std::cos(turn) * x - std::sin(turn) * y,
                                        double(cells) / 2 + std::sin(turn) * x + std::cos(turn) * y));
    }
  for (auto _ : state) benchmark::DoNotOptimize(pipeline::place_on_image(mosaic, map).found.has_value());
  state.SetItemsProcessed(state.iterations() * cells * cells);  // of the orthophoto
}
BENCHMARK(place_in_image)
    ->ArgName("cells")
    ->Arg(500)
    ->Arg(2000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
