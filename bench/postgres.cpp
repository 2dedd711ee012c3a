// SPDX-License-Identifier: Apache-2.0
// Storing a map of a million landmarks with ten features each in PostGIS, storing it again, and reading it.
// The server is one of the benchmark's own (tests/apps/postgres_site).
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "geodb/postgres/postgres_map.hpp"
#include "random_rocks.hpp"

namespace waymark::bench {
namespace {

constexpr double kSide = 100'000;  // m
const std::filesystem::path kFolder = std::filesystem::temp_directory_path() / "waymark_postgres_benchmark";
const std::filesystem::path kMap = kFolder / "map.gpkg", kBack = kFolder / "back.gpkg";
const std::string kServer = kFolder / "server";
const std::string kAddress = "pg:host=" + kServer + " dbname=maps user=owner";

bool site(const std::string& words) {
  return std::system((WAYMARK_SOURCE_DIR "/tests/apps/postgres_site " + words + " >/dev/null").c_str()) == 0;
}

void count(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

/// Creates the schema: rows, primary keys, GiST and uid indexes.
void Store(benchmark::State& state) {
  geodb::write_map(kMap, random_rocks(state.range(0), kSide));
  int schema = 0;
  for (auto _ : state)
    geodb::export_to_postgres(
        kMap, kAddress + " schema=s" + std::to_string(state.range(0)) + "_" + std::to_string(schema++));
  count(state);
}
BENCHMARK(Store)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(3);

/// Replaces every landmark of a schema by uid.
void Update(benchmark::State& state) {
  for (auto _ : state)
    geodb::export_to_postgres(kMap, kAddress + " schema=s" + std::to_string(state.range(0)) + "_0");
  count(state);
}
BENCHMARK(Update)->Arg(1'000'000)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);

void Fetch(benchmark::State& state) {
  for (auto _ : state)
    geodb::import_from_postgres(kAddress + " schema=s" + std::to_string(state.range(0)) + "_1", kBack);
  count(state);
}
BENCHMARK(Fetch)->Arg(1'000'000)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(3);

}  // namespace
}  // namespace waymark::bench

int main(int argc, char** argv) {
  using namespace waymark::bench;
  benchmark::Initialize(&argc, argv);
  if (!site("--available")) {
    std::puts("skipped: needs postgresql-15 and postgresql-15-postgis-3");
    return 0;
  }
  std::filesystem::create_directories(kFolder);
  std::filesystem::permissions(kFolder, std::filesystem::perms(0755));
  if (!site("start " + kServer)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  site("stop " + kServer);
  std::filesystem::remove_all(kFolder);
}
