// SPDX-License-Identifier: Apache-2.0
// Decoding LAZ: a million returns in chunks of 50,000, point formats 1 and 6; windows of a COPC file.
#include <benchmark/benchmark.h>
#include <cpl_vsi.h>
#include <tbb/global_control.h>

#include <map>
#include <random>

#include "importers/points/las_catalogue.hpp"
#include "tests/support/made_points.hpp"

namespace waymark::bench {
using namespace test;
namespace {

constexpr std::size_t kPoints = 1000000, kChunk = 50000;

std::string in_memory(const std::string& name, const std::string& bytes) {
  VSILFILE* file = VSIFOpenL(name.c_str(), "wb");
  VSIFWriteL(bytes.data(), 1, bytes.size(), file);
  VSIFCloseL(file);
  return name;
}

const std::string& laz_file(int format) {
  static std::map<int, std::string> made;
  std::string& name = made[format];
  if (!name.empty()) return name;
  const auto points = made_points(1, kPoints, format, 0);
  LazFile file{.format = format};
  for (auto from = points.begin(); from != points.end(); from += kChunk)
    file.chunks.emplace_back(from, from + kChunk);
  return name = in_memory("/vsimem/bench_" + std::to_string(format) + ".laz", laz_bytes(file));
}

void DecodeLaz(benchmark::State& state) {
  const importers::LasHeader header = importers::read_las_header(laz_file(static_cast<int>(state.range(0))));
  const auto runs = importers::las_runs(header);
  for (auto _ : state)
    for (const importers::LasRun& run : runs)
      benchmark::DoNotOptimize(importers::read_run(header, run).data());
  state.counters["points"] =
      benchmark::Counter(static_cast<double>(kPoints), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(DecodeLaz)->ArgName("format")->Arg(1)->Arg(6)->Unit(benchmark::kMillisecond);

void CatalogueLaz(benchmark::State& state) {
  const std::string& file = laz_file(static_cast<int>(state.range(0)));
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(1)));
  for (auto _ : state) benchmark::DoNotOptimize(importers::LasCatalogue({file}, 1 << 28).points());
  state.counters["points"] =
      benchmark::Counter(static_cast<double>(kPoints), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(CatalogueLaz)
    ->ArgNames({"format", "threads"})
    ->ArgsProduct({{1, 6}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// A window of a hundredth of the area, opened and read.
void CopcWindow(benchmark::State& state) {
  static const std::string name = [] {
    LazFile file{.format = 6, .scale = 0.01};
    std::mt19937 random(1);
    file.chunks.resize(1);
    for (std::size_t i = 0; i < kPoints / 2; ++i) {
      RawPoint p;
      p.at = {static_cast<std::int32_t>(random() % 50000) - 25000,
              static_cast<std::int32_t>(random() % 50000) - 25000,
              static_cast<std::int32_t>(random() % 3000)};
      p.classification = i % 3 == 0 ? 2 : 5;
      file.chunks[0].push_back(p);
    }
    return in_memory("/vsimem/bench.copc.laz", copc_bytes(file, 5));
  }();
  std::uint64_t decoded = 0, found = 0;
  for (auto _ : state) {
    const importers::LasCatalogue catalogue({name}, 1 << 28);
    found = 0;
    catalogue.visit({500000, 5000000, 500050, 5000050}, [&](const importers::LasPoint&) { ++found; });
    decoded = catalogue.runs_decoded();
  }
  state.counters["nodes"] = static_cast<double>(decoded);
  state.counters["found"] = static_cast<double>(found);
}
BENCHMARK(CopcWindow)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
