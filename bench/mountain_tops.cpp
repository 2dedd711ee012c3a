// SPDX-License-Identifier: Apache-2.0
// Cells per second of the two halves of mountain tops, in memory, on one thread; 1 to 64 million cells of
// hills.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

#include "pipeline/terrain/isolation.hpp"
#include "tests/pipeline/terrain/survey.hpp"

namespace waymark::bench {
using namespace test;
namespace {

// Hills of every size from a few cells up: octaves of smoothed lattice noise, whole metres as in SRTM.
Grid<double> hills(std::int64_t side) {
  const auto noise = [](std::int64_t x, std::int64_t y, std::int64_t octave) {
    std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u ^
                      static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu ^
                      static_cast<std::uint64_t>(octave) * 0x165667b19e3779f9u;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>(h >> 11) / 9007199254740992.0;
  };
  Grid<double> heights(side, side);
  for (std::int64_t octave = 3; octave <= 9; ++octave) {
    const std::int64_t step = std::int64_t{1} << octave;
    for (std::int64_t r = 0; r < side; ++r)
      for (std::int64_t c = 0; c < side; ++c) {
        const std::int64_t i = c / step, j = r / step;
        double u = static_cast<double>(c % step) / static_cast<double>(step),
               v = static_cast<double>(r % step) / static_cast<double>(step);
        u = u * u * (3 - 2 * u), v = v * v * (3 - 2 * v);
        heights(c, r) += 1.5 * static_cast<double>(step) *
                         ((1 - v) * ((1 - u) * noise(i, j, octave) + u * noise(i + 1, j, octave)) +
                          v * ((1 - u) * noise(i, j + 1, octave) + u * noise(i + 1, j + 1, octave)));
      }
  }
  for (double& z : heights.cells()) z = std::round(z);
  return heights;
}

const MemoryDem& dem_of(std::int64_t side) {
  static std::map<std::int64_t, std::unique_ptr<MemoryDem>> made;
  auto& dem = made[side];
  if (!dem)
    dem = std::make_unique<MemoryDem>(
        hills(side), Georeference{Crs::from_text("EPSG:4326"), 8, 47, 1 / 3600.0, -1 / 3600.0});
  return *dem;
}

void prominence(benchmark::State& state) {
  const auto& dem = dem_of(state.range(0));
  std::size_t summits = 0;
  for (auto _ : state) summits = survey(dem, 1024, 20).size();
  state.counters["cells/s"] = benchmark::Counter(static_cast<double>(dem.geometry().cells()),
                                                 benchmark::Counter::kIsIterationInvariantRate);
  state.counters["summits"] = static_cast<double>(summits);
}
BENCHMARK(prominence)->Arg(1000)->Arg(2000)->Arg(4000)->Arg(8000)->Unit(benchmark::kMillisecond);

void all_isolations(benchmark::State& state) {
  const auto& dem = dem_of(state.range(0));
  std::vector<pipeline::HighPoint> points;
  for (const pipeline::Summit& s : survey(dem, 1024)) points.push_back({s.cell, s.height});
  for (auto _ : state) {
    const pipeline::ReliefPyramid relief = pyramid_of(dem, 1024);
    benchmark::DoNotOptimize(pipeline::measure_isolation(points, dem, relief, {}));
  }
  state.counters["cells/s"] = benchmark::Counter(static_cast<double>(dem.geometry().cells()),
                                                 benchmark::Counter::kIsIterationInvariantRate);
  state.counters["summits/s"] =
      benchmark::Counter(static_cast<double>(points.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(all_isolations)->Arg(1000)->Arg(2000)->Arg(4000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
