// SPDX-License-Identifier: Apache-2.0
// Steps of belief, the information field, and routes over 1 km2 in cells of 2 m with 5000 clustered
// landmarks.
#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "planning/observability.hpp"
#include "planning/route_search.hpp"
#include "planning/sd_bounds.hpp"

namespace waymark::bench {
namespace {

using namespace planning;

void belief_step(benchmark::State& state) {
  Symmetric3 p{0.01, 0, 0.01, 0, 0, 0.001};
  const localization::OdometryNoise noise;
  for (auto _ : state) {
    p = update(predict(p, {2, 0.6, 0.8, 0.1}, noise), {0.3, 0.1, 0.4, 0.2, 0.1, 2});
    benchmark::DoNotOptimize(p);
  }
}
BENCHMARK(belief_step);

localization::LandmarkGrid clustered_landmarks() {
  Random random(3);
  std::vector<localization::MapLandmark> all;
  for (int cluster = 0; cluster < 100; ++cluster) {
    const double x = random.uniform(0, 1000), y = random.uniform(0, 1000);
    for (int i = 0; i < 50; ++i) {
      localization::MapLandmark l;
      l.at = {x + 15 * random.normal(), y + 15 * random.normal()};
      l.covariance = Eigen::Matrix2d::Identity() * 0.01;
      all.push_back(l);
    }
  }
  return localization::LandmarkGrid(all);
}

const LandmarkSensing kSensing{.coverage = {.range = 15, .range_sd = 0.1, .bearing_sd = 0.6}};

RouteProblem square_kilometre(const localization::LandmarkGrid& map) {
  RouteProblem problem;
  const RouteCells cells{.cell = 2, .columns = 501, .rows = 501};
  problem.passable.assign(static_cast<std::size_t>(cells.count()), 1);
  problem.field = make_information_field(cells, problem.passable, map, kSensing);
  problem.to = cells.count() - 1;
  problem.start = {0.01, 0, 0.01, 0, 0, 0.001};
  return problem;
}

void information_field(benchmark::State& state) {
  const auto map = clustered_landmarks();
  for (auto _ : state) benchmark::DoNotOptimize(square_kilometre(map));
}
BENCHMARK(information_field)->Unit(benchmark::kMillisecond)->UseRealTime();

void observability(benchmark::State& state) {
  const auto map = clustered_landmarks();
  ObservabilityRules rules;
  rules.sensing.coverage.range = 25;
  rules.sensing.coverage.view = static_cast<double>(state.range(0));
  double x = 0;
  for (auto _ : state) {
    x = std::fmod(x + 7.3, 1000);
    benchmark::DoNotOptimize(observability_at(x, 1000 - x, map, rules));
  }
}
BENCHMARK(observability)->Arg(360)->Arg(270)->Unit(benchmark::kMicrosecond);

// A cell of a raster from which nothing is seen: almost all of a map of mountain tops.
void observability_unseen(benchmark::State& state) {
  const auto map = clustered_landmarks();
  ObservabilityRules rules;
  rules.sensing.coverage.range = 25;
  const ObservabilityField field(map, rules);
  double x = 0;
  for (auto _ : state) {
    x = std::fmod(x + 7.3, 1000);
    benchmark::DoNotOptimize(field.at(x, 3000 + x));
  }
}
BENCHMARK(observability_unseen)->Unit(benchmark::kNanosecond);

// Lines of `range` metres over hills with cells of 30 m.
void line_of_sight(benchmark::State& state) {
  Grid<float> heights(800, 800);
  for (std::int64_t r = 0; r < 800; ++r)
    for (std::int64_t c = 0; c < 800; ++c)
      heights(c, r) = static_cast<float>(300 * std::sin(0.03 * double(c)) * std::cos(0.025 * double(r)) +
                                         20 * std::sin(0.3 * double(c + r)));
  const auto sees =
      localization::terrain_line_of_sight(Terrain(std::move(heights), 0, 12000, 15, 15), {}, 6371000, 0.13);
  Random random(5);
  const double range = double(state.range(0));
  for (auto _ : state) {
    const double x = random.uniform(0, 12000), y = random.uniform(0, 12000),
                 yaw = random.uniform(-3.14, 3.14);
    benchmark::DoNotOptimize(sees({x, y, 0}, {x + range * std::cos(yaw), y + range * std::sin(yaw)}));
  }
}
BENCHMARK(line_of_sight)->Arg(100)->Arg(6000)->Unit(benchmark::kNanosecond);

void route(benchmark::State& state) {
  const auto map = clustered_landmarks();
  const RouteProblem problem = square_kilometre(map);
  const double free = search_by_sigma(problem, {})->worst_sd;
  const double limit = double(state.range(1)) / 100 * free;
  for (auto _ : state) {
    const auto found =
        search_by_sigma(problem, {.max_sd = limit, .labels = static_cast<int>(state.range(0))});
    state.counters["metres"] = found ? found->length : 0;
    state.counters["worst_sd"] = found ? found->worst_sd : 0;
  }
  state.counters["limit"] = limit;
}
BENCHMARK(route)->ArgsProduct({{1, 4}, {100, 50, 25}})->Unit(benchmark::kMillisecond);

void weighted_route(benchmark::State& state) {
  const auto map = clustered_landmarks();
  RouteProblem problem = square_kilometre(map);
  problem.min_sd = relaxed_sd(problem, std::numeric_limits<double>::infinity());
  for (auto _ : state) {
    const auto found = search_by_sigma(
        problem, {.weight = double(state.range(1)) / 10, .labels = static_cast<int>(state.range(0))});
    state.counters["metres"] = found ? found->length : 0;
    state.counters["cost"] = found ? found->cost : 0;
  }
}
BENCHMARK(weighted_route)->ArgsProduct({{1, 4}, {1, 10, 100}})->Unit(benchmark::kMillisecond);

void relaxed_test(benchmark::State& state) {
  const auto map = clustered_landmarks();
  const RouteProblem problem = square_kilometre(map);
  for (auto _ : state) benchmark::DoNotOptimize(relaxed_sd(problem, 1));
}
BENCHMARK(relaxed_test)->Unit(benchmark::kMillisecond);

void keep_landmarks(benchmark::State& state) {
  const auto map = clustered_landmarks();
  const RouteProblem problem = square_kilometre(map);
  for (auto _ : state) benchmark::DoNotOptimize(search_by_landmarks(problem, 3, false));
}
BENCHMARK(keep_landmarks)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
