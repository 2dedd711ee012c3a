// SPDX-License-Identifier: Apache-2.0
// Hazard maps of fractal terrain, one thread: the fit of the base, and all bands with and without rocks.
#include <benchmark/benchmark.h>

#include <cmath>

#include "core/random.hpp"
#include "planning/hazard_map.hpp"
#include "testbed/noise.hpp"

namespace waymark::bench {
namespace {

constexpr std::int64_t kSize = 1024;

class FractalDem final : public DemSource {
 public:
  explicit FractalDem(double cell)
      : heights_(testbed::fractal_grid(
            {.longest = 200 * cell, .shortest = 2 * cell, .amplitude = 8 * cell, .hurst = 0.8, .seed = 1},
            {kSize, kSize, 0, 0, cell})) {
    geometry_ = {kSize, kSize, {.dx = cell, .dy = -cell}};
  }
  const GridGeometry& geometry() const override { return geometry_; }
  NodataPolicy nodata_policy() const override { return NodataPolicy::unknown; }
  HeightWindow read(const Window& window) const override {
    HeightWindow cells(window.columns, window.rows, kNoHeight);
    for (std::int64_t r = 0; r < window.rows; ++r)
      for (std::int64_t c = 0; c < window.columns; ++c)
        if (heights_.contains(window.column + c, window.row + r))
          cells(c, r) = double(heights_(window.column + c, window.row + r));
    return cells;
  }
  std::vector<std::string> files() const override { return {}; }

 private:
  Grid<float> heights_;
  GridGeometry geometry_;
};

// Radius of the base in cells.
void fit_base(benchmark::State& state) {
  const FractalDem dem(0.5);
  const double radius = 0.5 * double(state.range(0));
  const auto base = planning::make_base_footprint(0.5, 0.5, radius, 0.5 * radius);
  const std::int64_t m = base.half_columns, n = 512;
  const HeightWindow heights = dem.read({100 - m, 100 - m, n + 2 * m, n + 2 * m});
  for (auto _ : state) benchmark::DoNotOptimize(planning::fit_base(heights, {m, m, n, n}, base));
  state.SetItemsProcessed(state.iterations() * n * n);
}
BENCHMARK(fit_base)->Arg(2)->Arg(3)->Arg(6)->Arg(12)->Arg(24)->Unit(benchmark::kMillisecond);

void hazard_bands(benchmark::State& state, double cell, int rocks_per_hectare) {
  const FractalDem dem(cell);
  Random random(1);
  std::vector<planning::HazardObject> objects;
  const double side = double(kSize) * cell;
  for (int i = 0; i < int(rocks_per_hectare * side * side / 1e4); ++i)
    objects.push_back({.position = {random.uniform(0, side), -random.uniform(0, side)},
                       .covariance = Eigen::Matrix2d::Identity() * 0.01,
                       .radius = 0.5,
                       .radius_sd = 0.05,
                       .probability = 0.9});
  const planning::HazardMap map(
      dem, {.vehicle = planning::find_vehicle("rover"), .errors = {.sd = 0.02, .correlation = 2}}, objects);
  for (auto _ : state) benchmark::DoNotOptimize(map.compute({256, 256, 512, 512}));
  state.SetItemsProcessed(state.iterations() * 512 * 512);
}
BENCHMARK_CAPTURE(hazard_bands, half_metre, 0.5, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(hazard_bands, half_metre_100_rocks_per_ha, 0.5, 100)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(hazard_bands, quarter_metre, 0.25, 0)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
