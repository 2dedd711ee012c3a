// SPDX-License-Identifier: Apache-2.0
// Merging of observations into landmarks: rocks seen five times each on average, errors of 5 to 60 cm, rocks
// 5 m apart; all threads and one.
#include "pipeline/fusion/association/merging.hpp"

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "tests/pipeline/fusion/made_objects.hpp"

namespace waymark::bench {
using namespace test;
namespace {

std::vector<Observation> observations(std::uint32_t count) {
  const auto made =
      made_objects({.seed = 1, .things = count / 5, .images = 8, .spacing = 5, .recall = 0.625});
  TypeRegistry types;
  register_landmark_types(types);
  std::vector<Observation> all;
  for (const pipeline::ObservedObject& s : made.seen) {
    Observation o;
    o.type = types.id("rock");
    o.source = "image_" + std::to_string(s.source);
    o.position.xyz << s.at, 0;
    o.covariance.topLeftCorner<2, 2>() = s.covariance;
    o.covariance(2, 2) = 0.01;
    const double radius = std::exp(s.log_size);
    o.features = {{radius, radius * radius * s.log_size_variance, 1}, {}};
    all.push_back(o);
  }
  return all;
}

void merge(benchmark::State& state) {
  TypeRegistry types;
  register_landmark_types(types);
  const auto all = observations(static_cast<std::uint32_t>(state.range(0)));
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(1)));
  std::size_t landmarks = 0;
  for (auto _ : state) landmarks = pipeline::merge_observations(all, types, Crs::local()).landmarks.size();
  state.counters["observations"] = static_cast<double>(all.size());
  state.counters["landmarks"] = static_cast<double>(landmarks);
}
BENCHMARK(merge)
    ->ArgNames({"observations", "threads"})
    ->Args({100000, 1})
    ->Args({1000000, 1})
    ->Args({1000000, 2})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
