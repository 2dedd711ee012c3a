// SPDX-License-Identifier: Apache-2.0
// Writing and querying a map of a million landmarks with ten features each.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/layers/landmark_layout.hpp"
#include "geodb/map_store.hpp"
#include "geodb/sqlite/sqlite.hpp"
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

/// The same rows by SQLite alone, in the order of the landmarks, in a new file without a journal: what any
/// writer of this table must spend. With state.range(0), the unique index of uids as well; never an RTree.
void RawRows(benchmark::State& state) {
  const geodb::MapContents& map = million_map();
  const geodb::LandmarkLayout layout(map.types[0], 0);
  for (auto _ : state) {
    std::filesystem::remove(kMap);
    geodb::sqlite::Database database(kMap, geodb::sqlite::OpenMode::create);
    database.execute("PRAGMA page_size = 16384; PRAGMA cache_size = -8192; BEGIN");
    database.execute(layout.create_table());
    {
      geodb::sqlite::Statement insert = database.prepare(layout.insert());
      std::int64_t row = 0;
      for (const Landmark& landmark : map.landmarks) {
        const geodb::PointBlob geometry = geodb::point_blob(landmark.position.xyz, 32632);
        layout.bind(insert, ++row, landmark, geometry);
        insert.run();
      }
    }
    if (state.range(0) != 0) {
      database.execute("PRAGMA threads = 2");
      database.execute("CREATE UNIQUE INDEX rock_uid ON rock (uid)");
    }
    database.execute("COMMIT");
    database.close();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(map.landmarks.size()));
}
BENCHMARK(RawRows)
    ->ArgName("uid_index")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(3);

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
