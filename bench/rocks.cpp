// SPDX-License-Identifier: Apache-2.0
// Rocks by their shadows: megapixels per second of one thread, with many rocks and with few.
#include <benchmark/benchmark.h>

#include <cmath>

#include "core/random.hpp"
#include "pipeline/rocks/find_rocks.hpp"
#include "pipeline/rocks/synthetic_rock.hpp"
#include "pipeline/vision/local_background.hpp"
namespace waymark::bench {
namespace {

// A noisy image with drawn rocks, `per_megapixel` of them.
Pixels field(std::int64_t side, double per_megapixel) {
  Pixels image(side, side);
  Random random(1);
  for (float& value : image.cells()) value = static_cast<float>(random.normal(120, 1.5));
  const auto count = static_cast<int>(per_megapixel * static_cast<double>(side * side) * 1e-6);
  for (int i = 0; i < count; ++i) {
    pipeline::SyntheticRock rock{.radius = random.log_uniform(0.8, 6), .reach = 0, .x = 16, .y = 16};
    rock.reach = rock.radius * random.uniform(0.8, 1.6);
    const Grid<float> picture = pipeline::render_rock_shadow(rock, 40, 32);
    const auto x0 = static_cast<std::int64_t>(random.uniform_index(static_cast<std::uint64_t>(side - 40)));
    const auto y0 = static_cast<std::int64_t>(random.uniform_index(static_cast<std::uint64_t>(side - 32)));
    for (std::int64_t y = 0; y < 32; ++y)
      for (std::int64_t x = 0; x < 40; ++x) image(x0 + x, y0 + y) -= 100 * picture(x, y);
  }
  return image;
}

void find(benchmark::State& state, pipeline::RockMethod method) {
  const Pixels image = field(4096, static_cast<double>(state.range(0)));
  const pipeline::RockSearch search{.method = method, .sun_angle = Radians{0}, .sun_elevation = Radians{0.7}};
  std::size_t rocks = 0;
  for (auto _ : state) rocks = pipeline::find_rocks(image, search).size();
  state.counters["rocks"] = static_cast<double>(rocks);
  state.SetItemsProcessed(state.iterations() * 4096 * 4096);  // pixels
}
void shadow(benchmark::State& state) {
  find(state, pipeline::RockMethod::shadow);
}
void classic(benchmark::State& state) {
  find(state, pipeline::RockMethod::classic);
}
BENCHMARK(shadow)->Arg(50)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(classic)->Arg(1000)->Unit(benchmark::kMillisecond);

void background(benchmark::State& state) {
  const Pixels image = field(4096, 50);
  for (auto _ : state) benchmark::DoNotOptimize(pipeline::local_background(image, 32).level(0, 0));
  state.SetItemsProcessed(state.iterations() * 4096 * 4096);
}
BENCHMARK(background)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench
BENCHMARK_MAIN();
