// SPDX-License-Identifier: Apache-2.0
// Adjustment of an aerial block with self-calibration: the last solution with its covariances. One thread.
#include <benchmark/benchmark.h>

#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/adjustment/triangulate.hpp"
#include "tests/pipeline/reconstruction/made_scene.hpp"

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

void triangulate_points(benchmark::State& state) {
  const MadeScene made = made_scene(block(4));
  for (auto _ : state)
    for (const pipeline::TiePoint& point : made.truth.points)
      benchmark::DoNotOptimize(pipeline::triangulate(made.truth, point.marks));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(made.truth.points.size()));
}
BENCHMARK(triangulate_points)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
