// SPDX-License-Identifier: Apache-2.0
// Craters in a synthetic scene: pixels per second. Target: 1.5 Mpx/s per core.
#include <benchmark/benchmark.h>

#include "pipeline/craters/find_craters.hpp"
#include "pipeline/craters/shaded_scene.hpp"

namespace {

using namespace waymark;

const pipeline::LabelledScene& scene() {
  static const pipeline::LabelledScene made = pipeline::shaded_scene(5001, 1024);
  return made;
}

void find(benchmark::State& state, pipeline::CraterMethod method, bool verify, bool second_opinion) {
  pipeline::CraterSearch search;
  search.method = method;
  search.verify = verify;
  search.second_opinion = second_opinion;
  search.sun_angle = scene().sun_angle;
  for (auto _ : state) benchmark::DoNotOptimize(pipeline::find_craters(scene().image, search));
  state.SetItemsProcessed(state.iterations() * scene().image.columns() * scene().image.rows());
}

BENCHMARK_CAPTURE(find, bowl, pipeline::CraterMethod::bowl, true, true)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(find, bowl_without_verifier, pipeline::CraterMethod::bowl, true, false)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(find, bowl_without_model, pipeline::CraterMethod::bowl, false, false)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(find, edges, pipeline::CraterMethod::edges, true, false)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

void sun(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(pipeline::estimate_crater_sun_angle(scene().image));
  state.SetItemsProcessed(state.iterations() * scene().image.columns() * scene().image.rows());
}
BENCHMARK(sun)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
