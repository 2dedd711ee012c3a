// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "core/random.hpp"
#include "pipeline/forest/stand_cover.hpp"

namespace waymark::bench {
namespace {

// A square kilometre with 50,000 trees.
std::vector<pipeline::StandTree> forest() {
  Random random(1);
  std::vector<pipeline::StandTree> trees;
  for (int i = 0; i < 50'000; ++i) {
    pipeline::StandTree t{.position = {random.uniform(0, 1000), random.uniform(0, 1000)}, .position_sd = 0.5};
    t.height = random.uniform(8, 32), t.height_sd = 0.8;
    t.diameter = random.uniform(0.1, 0.5), t.diameter_sd = 0.05;
    t.volume = pipeline::stem_volume(pipeline::built_in_volume()[0], t.diameter, t.height);
    t.confidence = 0.9;
    trees.push_back(t);
  }
  return trees;
}

pipeline::StandPolygon square(double x, double y, double side) {
  return {{{{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}}}};
}

void inventory_per_hectare(benchmark::State& state) {
  const std::vector<pipeline::StandTree> trees = forest();
  for (auto _ : state)
    for (int i = 0; i < 100; ++i)
      benchmark::DoNotOptimize(pipeline::inventory(trees, square(100.0 * (i % 10), 100.0 * (i / 10), 100)));
}
BENCHMARK(inventory_per_hectare)->Unit(benchmark::kMillisecond);

void canopy_cover_square_kilometre(benchmark::State& state) {
  std::vector<pipeline::StandCrown> crowns;
  for (const pipeline::StandTree& t : forest())
    crowns.push_back({.position = t.position, .diameter = 4, .confidence = 0.9});
  for (auto _ : state) benchmark::DoNotOptimize(pipeline::canopy_cover(crowns, square(0, 0, 1000)));
}
BENCHMARK(canopy_cover_square_kilometre)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
