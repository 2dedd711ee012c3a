// SPDX-License-Identifier: Apache-2.0
// Trees: whole rasters on one thread.
#include <benchmark/benchmark.h>
#include <gdal_priv.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "core/random.hpp"
#include "importers/points/canopy.hpp"
#include "importers/points/las_catalogue.hpp"
#include "pipeline/forest/crown_network.hpp"
#include "pipeline/forest/find_trees.hpp"

namespace {

using namespace waymark;

constexpr std::int64_t kSide = 2000;  // 1 km2 of 0.5 m

// 600 rounded crowns a hectare with rough bark.
Grid<float> forest() {
  Random random(1, "bench forest");
  Grid<float> heights(kSide, kSide, 0);
  for (int t = 0; t < 60000; ++t) {
    const double x = random.uniform() * kSide, y = random.uniform() * kSide, top = 8 + 20 * random.uniform();
    const double radius = 1.6 + 0.22 * top;
    const auto first = [&](double v) { return static_cast<std::int64_t>(std::max(0.0, v - radius)); };
    const auto last = [&](double v) { return std::min(kSide - 1, static_cast<std::int64_t>(v + radius)); };
    for (std::int64_t r = first(y); r <= last(y); ++r)
      for (std::int64_t c = first(x); c <= last(x); ++c) {
        const double away = std::hypot(static_cast<double>(c) - x, static_cast<double>(r) - y) / radius;
        if (away < 1)
          heights(c, r) = std::max(heights(c, r), static_cast<float>(top * (1 - 0.6 * away * away)));
      }
  }
  for (float& h : heights.cells())
    if (h > 0) h = std::max(0.0F, h + static_cast<float>(0.6 * (random.uniform() - 0.5)));
  return heights;
}

const std::string& forest_file() {
  static const std::string path = [] {
    GDALAllRegister();
    const std::string name = "/vsimem/bench_chm.tif";
    const char* const options[] = {"TILED=YES", nullptr};
    Grid<float> heights = forest();
    GDALDataset* file = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        name.c_str(), kSide, kSide, 1, GDT_Float32, const_cast<char**>(options));
    double place[] = {500000, 0.5, 0, 5000000, 0, -0.5};
    file->SetGeoTransform(place);
    OGRSpatialReference crs;
    crs.importFromEPSG(32633);
    file->SetSpatialRef(&crs);
    if (file->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, kSide, kSide, heights.cells().data(), kSide, kSide,
                                         GDT_Float32, 0, 0, nullptr) != CE_None)
      std::abort();
    GDALClose(file);
    return name;
  }();
  return path;
}

void search(benchmark::State& state, const pipeline::TreeSearch& how) {
  const std::string& file = forest_file();
  std::size_t trees = 0;
  for (auto _ : state) {
    const auto canopy = importers::import_canopy({.chm = {file}, .inspect = false});
    trees = 0;
    for (std::int64_t row = 0; row < kSide; row += 1024)
      for (std::int64_t column = 0; column < kSide; column += 1024)
        trees += pipeline::find_trees(*canopy,
                                      {column, row, std::min<std::int64_t>(1024, kSide - column),
                                       std::min<std::int64_t>(1024, kSide - row)},
                                      how)
                     .size();
  }
  state.counters["trees"] = static_cast<double>(trees);
  state.counters["cells"] =
      benchmark::Counter(static_cast<double>(kSide * kSide), benchmark::Counter::kIsIterationInvariantRate);
}

void Treetops(benchmark::State& state) {
  pipeline::TreeSearch how{.crowns = false};
  how.forest.tops.prominence = 0;
  search(state, how);
}
BENCHMARK(Treetops)->Unit(benchmark::kMillisecond);

void TreetopsWithProminence(benchmark::State& state) {
  search(state, {.crowns = false});
}
BENCHMARK(TreetopsWithProminence)->Unit(benchmark::kMillisecond);

void TreesWithCrowns(benchmark::State& state) {
  search(state, {});
}
BENCHMARK(TreesWithCrowns)->Unit(benchmark::kMillisecond);

void LocalMaxima(benchmark::State& state) {
  pipeline::TreeSearch how{.crowns = false};
  how.forest = pipeline::local_maxima_preset(how.forest);
  search(state, how);
}
BENCHMARK(LocalMaxima)->Unit(benchmark::kMillisecond);

// A LAS 1.2 file, format 1, of random points.
const std::string& las_file() {
  static const std::string path = [] {
    constexpr std::uint32_t kPoints = 2000000;
    std::string bytes(227 + std::size_t{28} * kPoints, '\0');
    const auto put = [&](std::size_t at, const auto& value) {
      std::memcpy(bytes.data() + at, &value, sizeof value);
    };
    std::memcpy(bytes.data(), "LASF", 4);
    bytes[24] = 1, bytes[25] = 2, bytes[104] = 1;
    put(94, std::uint16_t{227}), put(96, std::uint32_t{227}), put(105, std::uint16_t{28}), put(107, kPoints);
    for (const std::size_t i : {0, 1, 2}) put(131 + 8 * i, 0.01);
    Random random(2, "bench points");
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      const std::size_t at = 227 + std::size_t{28} * i;
      for (const std::size_t axis : {0, 1, 2})
        put(at + 4 * axis, static_cast<std::int32_t>(random.uniform() * 50000));
      bytes[at + 14] = 9, bytes[at + 15] = static_cast<char>(i % 4 ? 5 : 2);
    }
    const std::string name = "/vsimem/bench.las";
    VSILFILE* file = VSIFOpenL(name.c_str(), "wb");
    VSIFWriteL(bytes.data(), 1, bytes.size(), file);
    VSIFCloseL(file);
    return name;
  }();
  return path;
}

void ReadLas(benchmark::State& state) {
  const std::string& file = las_file();
  for (auto _ : state) {
    const importers::LasHeader header = importers::read_las_header(file);
    benchmark::DoNotOptimize(importers::read_las_points(header, 0, header.points).data());
  }
  state.counters["points"] = benchmark::Counter(2e6, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(ReadLas)->Unit(benchmark::kMillisecond);

void CatalogueLas(benchmark::State& state) {
  const std::string& file = las_file();
  for (auto _ : state) benchmark::DoNotOptimize(importers::LasCatalogue({file}, 1 << 28).points());
  state.counters["points"] = benchmark::Counter(2e6, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(CatalogueLas)->Unit(benchmark::kMillisecond);

void CrownsOfColour(benchmark::State& state) {
  constexpr std::int64_t side = 768;
  const std::int64_t reach = pipeline::crown_probability_reach(0.6);
  Random random(2, "bench colours");
  pipeline::ColourWindow image{{-reach, -reach, side + 2 * reach, side + 2 * reach}, 0.6, {}};
  image.bands.assign(4, Grid<float>(side + 2 * reach, side + 2 * reach));
  for (auto& band : image.bands)
    for (float& value : band.cells()) value = static_cast<float>(random.uniform());
  for (auto _ : state)
    benchmark::DoNotOptimize(
        pipeline::crown_probability(image, {0, 0, side, side}, pipeline::crown_network_infrared()));
  state.counters["pixels"] =
      benchmark::Counter(double(side * side), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(CrownsOfColour)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
