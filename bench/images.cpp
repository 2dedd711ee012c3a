// SPDX-License-Identifier: Apache-2.0
// Rays through lenses, and images read.
#include <benchmark/benchmark.h>
#include <gdal_priv.h>

#include <vector>

#include "geo/camera.hpp"
#include "importers/images/image.hpp"

namespace waymark::bench {
namespace {

Camera lens(bool distorted) {
  Camera camera{.columns = 4000, .rows = 3000, .fx = 3600, .fy = 3600, .cx = 1999.5, .cy = 1499.5};
  if (distorted) camera.distortion = {-0.26, 0.1, 7e-4, 2.6e-4, -0.026};
  return camera;
}

void project_point(benchmark::State& state) {
  const Camera camera = lens(state.range(0) != 0);
  double x = -0.4;
  for (auto _ : state) {
    benchmark::DoNotOptimize(project(camera, {Eigen::Vector3d(x, 0.2, 1)}));
    x = x > 0.4 ? -0.4 : x + 1e-3;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(project_point)->ArgName("distorted")->Arg(0)->Arg(1);

void ray_of_pixel(benchmark::State& state) {
  const Camera camera = lens(state.range(0) != 0);
  double x = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ray(camera, {x, 700}));
    x = x > 3999 ? 0 : x + 1;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(ray_of_pixel)->ArgName("distorted")->Arg(0)->Arg(1);

void read_image(benchmark::State& state) {
  GDALAllRegister();
  const int bands = static_cast<int>(state.range(0)), side = 2000;
  const char* path = "/vsimem/bench.tif";
  {
    const char* const options[] = {"TILED=YES", "PHOTOMETRIC=RGB", nullptr};
    const std::unique_ptr<GDALDataset> file(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path, side, side, bands, GDT_Byte, bands == 3 ? const_cast<char**>(options) : nullptr));
    std::vector<unsigned char> row(side, 100);
    for (int b = 1; b <= bands; ++b)
      for (int r = 0; r < side; ++r)
        if (file->GetRasterBand(b)->RasterIO(GF_Write, 0, r, side, 1, row.data(), side, 1, GDT_Byte, 0, 0,
                                             nullptr) != CE_None)
          state.SkipWithError("cannot write");
  }
  const auto image = importers::import_image(path);
  for (auto _ : state) benchmark::DoNotOptimize(image->read({0, 0, side, side}));
  state.counters["Mpx/s"] = benchmark::Counter(static_cast<double>(state.iterations()) * side * side / 1e6,
                                               benchmark::Counter::kIsRate);
}
BENCHMARK(read_image)->ArgName("bands")->Arg(1)->Arg(3)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
