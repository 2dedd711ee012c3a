// SPDX-License-Identifier: Apache-2.0
// Heights from five images of 160 x 160 pixels of a cratered site: all threads and one; paths, correlations
// and refinement alone.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <numeric>

#include "core/random.hpp"
#include "pipeline/reconstruction/surface/refine_heights.hpp"
#include "pipeline/reconstruction/surface/sweep_heights.hpp"
#include "tests/pipeline/reconstruction/made_views.hpp"

namespace waymark::bench {
namespace {

void sweep(benchmark::State& state) {
  const auto views = test::made_flight(test::made_site(5));
  pipeline::SweepPlan plan;
  plan.range = {-8, 8};
  plan.grid = *pipeline::overlap_grid(views, plan.range, 0.86);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(0)));
  std::int64_t kept = 0;
  for (auto _ : state) kept = pipeline::sweep_heights(views, plan).kept();
  state.counters["cells"] = static_cast<double>(kept);
  state.counters["seconds_per_Mpx"] = benchmark::Counter(
      5 * 160 * 160 / 1e6, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(sweep)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

void paths(benchmark::State& state) {
  pipeline::CostVolume volume{.columns = 320, .rows = 320, .steps = 17};
  Random random(1);
  volume.cost.resize(320 * 320 * 17);
  for (std::uint8_t& cost : volume.cost) cost = static_cast<std::uint8_t>(random.uniform() * 128);
  for (auto _ : state) benchmark::DoNotOptimize(pipeline::sum_path_costs(volume, {}));
  state.SetItemsProcessed(state.iterations() * 320 * 320 * 17);
}
BENCHMARK(paths)->Unit(benchmark::kMillisecond);

void correlations(benchmark::State& state) {
  Random random(1);
  std::vector<pipeline::Resampled> views(8, pipeline::Resampled(38, 38));
  for (auto& view : views)
    for (float& value : view.reshaped()) value = static_cast<float>(random.normal());
  const std::vector<double> min_sd(8, 0);
  std::vector<pipeline::ViewPair> pairs;
  for (std::size_t i = 0; i < 16; ++i) pairs.push_back({i / 2, (i / 2 + 1 + i % 2) % 8, 0.3});
  for (auto _ : state) benchmark::DoNotOptimize(pipeline::correlate_windows(views, min_sd, pairs));
  state.SetItemsProcessed(state.iterations() * 32 * 32 * 16);
}
BENCHMARK(correlations)->Unit(benchmark::kMicrosecond);

// 64 x 64 cells of 0.86 m, which five views see.
void refinement(benchmark::State& state) {
  const auto views = test::made_flight(test::made_site(5));
  pipeline::ImageLevels images(views, std::size_t{1} << 30);
  const pipeline::SurfaceGrid grid{.west = -27.5, .north = 27.5, .cell = 0.86, .columns = 64, .rows = 64};
  std::vector<std::size_t> used(views.size());
  std::iota(used.begin(), used.end(), std::size_t{0});
  Random random(1);
  Grid<float> heights(64, 64);
  for (float& height : heights.cells()) height = static_cast<float>(0.3 * random.normal());
  const Grid<float> sd(64, 64, 0.3f);
  const auto at = [&](std::int64_t, std::int64_t) {
    return pipeline::ComparedViews{views, images, used, 0.4};
  };
  for (auto _ : state)
    benchmark::DoNotOptimize(pipeline::refine_heights(heights, sd, grid, {0, 0, 64, 64}, 16, at, {}));
  state.SetItemsProcessed(state.iterations() * 64 * 64);
}
BENCHMARK(refinement)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
