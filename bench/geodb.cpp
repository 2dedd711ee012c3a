// SPDX-License-Identifier: Apache-2.0
// Writing and querying a map of a million landmarks with ten features each.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "geodb/map_store.hpp"
#include "geodb/write_map.hpp"
#include "random_rocks.hpp"

namespace waymark::bench {
namespace {

constexpr double kSide = 100'000;  // m
const std::filesystem::path kMap = std::filesystem::temp_directory_path() / "waymark_geodb_benchmark.gpkg";

const geodb::MapContents& million_map() {
  static const geodb::MapContents map = random_rocks(1'000'000, kSide);
  return map;
}

void WriteMap(benchmark::State& state) {
  const geodb::MapContents& map = million_map();
  for (auto _ : state) geodb::write_map(kMap, map);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(map.landmarks.size()));
  state.counters["bytes"] = static_cast<double>(std::filesystem::file_size(kMap)) / 1e6;
}
BENCHMARK(WriteMap)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(3);

/// Boxes that hold state.range(0) landmarks on average, at random places.
void BoxQuery(benchmark::State& state) {
  static const geodb::MapStore map = (geodb::write_map(kMap, million_map()), geodb::MapStore::open(kMap));
  const double side = kSide * std::sqrt(static_cast<double>(state.range(0)) / 1e6);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> place(0, kSide - side);
  std::size_t hits = 0;
  for (auto _ : state) {
    const double x = 400'000 + place(random), y = 5'000'000 + place(random);
    hits += map.query({.box = geodb::MapQuery::Box{x, y, x + side, y + side}}).size();
  }
  state.counters["hits"] = benchmark::Counter(static_cast<double>(hits), benchmark::Counter::kAvgIterations);
}
BENCHMARK(BoxQuery)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

void NearestTen(benchmark::State& state) {
  const geodb::MapStore map = geodb::MapStore::open(kMap);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(0, kSide);
  for (auto _ : state)
    benchmark::DoNotOptimize(map.query(
        {.nearest = geodb::MapQuery::NearestK{400'000 + place(random), 5'000'000 + place(random), 10}}));
}
BENCHMARK(NearestTen)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace waymark::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  std::filesystem::remove(waymark::bench::kMap);
}
