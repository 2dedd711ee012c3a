// SPDX-License-Identifier: Apache-2.0
// Reading heights from a GeoTIFF: 3601 x 3601 Int16, read in tiles of 1024 cells with a border of
// one.
#include <benchmark/benchmark.h>
#include <gdal_priv.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "importers/rasters/dem.hpp"

namespace {

using namespace waymark;

constexpr int kSide = 3601;
constexpr std::int64_t kTile = 1024;

// Hills with a little roughness: deflate shrinks them about as much as SRTM. Every 20th block of cells is
// void.
std::string make_dem(const char* name, std::vector<const char*> options) {
  GDALAllRegister();
  options.push_back(nullptr);
  const std::string path = std::string("/vsimem/") + name + ".tif";
  auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const std::unique_ptr<GDALDataset> dataset(
      driver->Create(path.c_str(), kSide, kSide, 1, GDT_Int16, const_cast<char**>(options.data())));
  double transform[] = {-71, 1.0 / 3600, 0, -32, 0, -1.0 / 3600};
  OGRSpatialReference wgs84;
  wgs84.SetFromUserInput("EPSG:4326");
  bool written = dataset->SetGeoTransform(transform) == CE_None && dataset->SetSpatialRef(&wgs84) == CE_None;
  std::vector<std::int16_t> row(kSide);
  unsigned noise = 1;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      noise = noise * 1664525u + 1013904223u;
      const double hills =
          3000 + 900 * std::sin(x / 211.0) * std::cos(y / 173.0) + 80 * std::sin((x + y) / 17.0);
      const bool empty = (x / 64 + y / 64) % 20 == 0;
      row[static_cast<std::size_t>(x)] = static_cast<std::int16_t>(empty ? -32768 : hills + (noise >> 30));
    }
    written &= dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, y, kSide, 1, row.data(), kSide, 1, GDT_Int16,
                                                   0, 0, nullptr) == CE_None;
  }
  written &= dataset->GetRasterBand(1)->SetNoDataValue(-32768) == CE_None;
  return written ? path : "";
}

void read_all(const DemSource& dem, int thread_count) {
  constexpr std::int64_t across = (kSide + kTile - 1) / kTile;
  std::atomic<std::int64_t> next = 0;
  const auto work = [&] {
    for (std::int64_t tile; (tile = next++) < across * across;) {
      const std::int64_t left = tile % across * kTile, top = tile / across * kTile;
      benchmark::DoNotOptimize(
          dem.read({left - 1, top - 1, std::min(kTile, kSide - left) + 2, std::min(kTile, kSide - top) + 2}));
    }
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < thread_count; ++i) others.emplace_back(work);
  work();
}

void count_cells(benchmark::State& state) {
  state.counters["cells/s"] = benchmark::Counter(static_cast<double>(state.iterations()) * kSide * kSide,
                                                 benchmark::Counter::kIsRate);
}

// Opens the file each time: decompression included.
void from_file(benchmark::State& state, const std::string& path, NodataPolicy policy) {
  for (auto _ : state)
    read_all(*importers::import_dem({.files = {path}, .nodata = policy}), static_cast<int>(state.range(0)));
  count_cells(state);
}

// Cached blocks: cost of the conversion to double.
void from_cache(benchmark::State& state, const std::string& path) {
  const auto dem = importers::import_dem({.files = {path}});
  read_all(*dem, 1);
  for (auto _ : state) read_all(*dem, static_cast<int>(state.range(0)));
  count_cells(state);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string tiled = make_dem("tiled", {"TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=2"});
  const std::string strips = make_dem("strips", {"COMPRESS=DEFLATE"});
  const std::string plain = make_dem("plain", {"TILED=YES"});
  const auto bench = [](const char* name, auto&&... arguments) {
    benchmark::RegisterBenchmark(name, arguments...)
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  };
  bench("deflate, tiles of 256", from_file, tiled, NodataPolicy::ocean);
  bench("deflate, strips", from_file, strips, NodataPolicy::ocean);
  bench("uncompressed", from_file, plain, NodataPolicy::ocean);
  bench("deflate, voids filled", from_file, tiled, NodataPolicy::fill);
  bench("blocks in memory", from_cache, tiled);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
