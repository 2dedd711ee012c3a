// SPDX-License-Identifier: Apache-2.0
// Overhead of the engine: a run whose units do nothing.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "pipeline/engine/runner.hpp"
#include "pipeline/engine/stage.hpp"
namespace waymark::pipeline {

template <>
struct Codec<std::int64_t> {
  static std::string encode(const std::int64_t& number) { return std::to_string(number); }
  static std::int64_t decode(std::string_view text) { return std::stoll(std::string(text)); }
};

}  // namespace waymark::pipeline

namespace waymark::bench {

namespace {

struct List {
  struct Options {
    std::int64_t tiles = 1;
    void describe(OptionVisitor& option) { option("tiles", tiles, {.help = "How many tiles there are"}); }
  };
  static constexpr pipeline::Out<std::vector<pipeline::Tile>> tiles{"tiles"};
  static pipeline::StageSpec spec() {
    return {.name = "list", .summary = "", .lists = pipeline::Scope::tile, .outputs = {tiles}};
  }
  static void run(const Options& options, pipeline::StageContext& unit) {
    std::vector<pipeline::Tile> list;
    for (std::int64_t i = 0; i < options.tiles; ++i)
      list.push_back({.index = i, .column = i, .row = 0, .cells = {}});
    unit.write(tiles, std::move(list));
  }
};

struct NoOptions {
  void describe(OptionVisitor&) {}
};

struct Count {
  using Options = NoOptions;
  static constexpr pipeline::Out<std::int64_t> count{"count"};
  static pipeline::StageSpec spec() {
    return {.name = "count", .summary = "", .scope = pipeline::Scope::tile, .outputs = {count}};
  }
  static void run(const Options&, pipeline::StageContext& unit) {
    unit.count_in(1);
    unit.count_out(1);
    unit.write(count, unit.tile().index);
  }
};

struct Sum {
  using Options = NoOptions;
  static constexpr pipeline::In<std::int64_t> count{"count"};
  static constexpr pipeline::Out<std::int64_t> sum{"sum"};
  static pipeline::StageSpec spec() {
    return {.name = "sum", .summary = "", .inputs = {count}, .outputs = {sum}};
  }
  static void run(const Options&, pipeline::StageContext& unit) {
    std::int64_t total = 0;
    for (const auto& part : unit.read_all(count)) total += *part;
    unit.write(sum, total);
  }
};

pipeline::Pipeline pipeline_of(const pipeline::Registry& registry, std::int64_t tiles) {
  pipeline::Pipeline pipeline(registry);
  pipeline.add<List>({.tiles = tiles}).add<Count>().add<Sum>();
  return pipeline;
}

void run_in_memory(benchmark::State& state) {
  const pipeline::Registry registry;
  const pipeline::Pipeline pipeline = pipeline_of(registry, state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(pipeline::run(pipeline, {.threads = 2}));
}
BENCHMARK(run_in_memory)->Arg(1)->Arg(16)->Arg(64)->Arg(10'000)->Unit(benchmark::kMillisecond)->UseRealTime();

void run_with_work_folder(benchmark::State& state) {
  const pipeline::Registry registry;
  const pipeline::Pipeline pipeline = pipeline_of(registry, state.range(0));
  const auto work = std::filesystem::temp_directory_path() / "waymark_bench_engine";
  for (auto _ : state) {
    std::filesystem::remove_all(work);
    benchmark::DoNotOptimize(pipeline::run(pipeline, {.work = work, .threads = 2}));
  }
}
BENCHMARK(run_with_work_folder)->Arg(64)->Arg(1'000)->Unit(benchmark::kMillisecond)->UseRealTime();

void resume_finished_run(benchmark::State& state) {
  const pipeline::Registry registry;
  const pipeline::Pipeline pipeline = pipeline_of(registry, state.range(0));
  const auto work = std::filesystem::temp_directory_path() / "waymark_bench_engine";
  std::filesystem::remove_all(work);
  pipeline::run(pipeline, {.work = work});
  for (auto _ : state) benchmark::DoNotOptimize(pipeline::run(pipeline, {.work = work, .threads = 2}));
}
BENCHMARK(resume_finished_run)->Arg(64)->Arg(1'000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace waymark::bench

BENCHMARK_MAIN();
