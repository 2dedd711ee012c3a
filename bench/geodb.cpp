// SPDX-License-Identifier: Apache-2.0
// Writing and querying a map of a million landmarks with ten features each.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "geodb/map_store.hpp"
#include "geodb/write_map.hpp"

namespace waymark::bench {
namespace {

constexpr double kSide = 100'000;  // m
const std::filesystem::path kMap = std::filesystem::temp_directory_path() / "waymark_geodb_benchmark.gpkg";

geodb::MapContents million(std::int64_t count) {
  geodb::MapContents map;
  map.crs = Crs::from_text("EPSG:32632");
  LandmarkType type;
  type.name = "rock";
  for (int i = 0; i < 10; ++i) {
    type.features.emplace_back();
    type.features.back().name = "feature_" + std::to_string(i);
  }
  map.types.add(type);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0, kSide), value(1, 100);
  map.landmarks.resize(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    Landmark& landmark = map.landmarks[i];
    landmark.uid = "rock-" + std::to_string(random());
    landmark.position.xyz = {400'000 + place(random), 5'000'000 + place(random), value(random)};
    landmark.features.resize(10);
    for (FeatureValue& feature : landmark.features) feature = {value(random), 0.25, 3};
    landmark.quality = {
        .seen = 3, .visible = 4, .feature_confidences = std::vector<std::optional<double>>(10, 0.9)};
    landmark.observations = 3;
  }
  return map;
}

const geodb::MapContents& million_map() {
  static const geodb::MapContents map = million(1'000'000);
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
