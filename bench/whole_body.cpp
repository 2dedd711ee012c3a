// SPDX-License-Identifier: Apache-2.0
// Images located by craters of a whole body of 1e4 to 1e6 craters, their scale unknown: time of the index,
// and of a search by processor time. One image in four is scrambled: no position is right.
#include <benchmark/benchmark.h>

#include "tests/localization/made_craters.hpp"

namespace waymark::bench {
namespace {

using localization::CraterIndex;

constexpr double kMoonCraters = 1e5, kRadiusOfThese = 2000;  // m, the smallest

/// Returns the smallest radius of a catalogue of that many craters of one body.
double min_radius(std::int64_t count) {
  return kRadiusOfThese * std::sqrt(kMoonCraters / static_cast<double>(count));
}

void crater_index(benchmark::State& state) {
  const auto craters =
      test::made_craters(static_cast<std::size_t>(state.range(0)), min_radius(state.range(0)), moon(), 1);
  for (auto _ : state) {
    const CraterIndex index(craters, moon());
    state.counters["bytes/crater"] = static_cast<double>(index.bytes()) / static_cast<double>(index.size());
  }
}
BENCHMARK(crater_index)->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond)->Iterations(1);

void crater_search(benchmark::State& state) {
  const double smallest = min_radius(state.range(0));
  const auto craters = test::made_craters(static_cast<std::size_t>(state.range(0)), smallest, moon(), 1);
  Random random(2, "images");
  const CraterIndex index(test::surveyed(craters, moon(), random), moon());
  const test::CraterSensor how;
  std::vector<test::MadeCraterImage> images;
  while (images.size() < 16) {
    const auto pose = test::anywhere(moon(), random.log_uniform(smallest / 13, smallest / 4), how, random);
    auto image = test::look_down(craters, moon(), pose, how, random);
    if (image.craters.size() < 12) continue;
    if (images.size() % 4 == 3)
      for (localization::ImageCrater& c : image.craters)
        c.at = how.side * Eigen::Vector2d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    images.push_back(std::move(image));
  }
  std::size_t found = 0, tries = 0;
  for (auto _ : state) {
    const test::MadeCraterImage& image = images[tries++ % images.size()];
    found += index
                 .find({.craters = image.craters,
                        .size = Eigen::Vector2d::Constant(how.side),
                        .camera = localization::GroundCamera(how.focal)})
                 .fix.has_value();
  }
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(tries);
}
BENCHMARK(crater_search)
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->Iterations(16);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
