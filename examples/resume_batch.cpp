// SPDX-License-Identifier: Apache-2.0
// Splits a run into shards and resumes it: results in the work folder are reused.
#include <filesystem>
#include <iostream>
#include <waymark/mapping.hpp>
using namespace waymark;

namespace {

std::int64_t units_computed(const pipeline::RunReport& report) {
  std::int64_t made = 0;
  for (const pipeline::StageReport& stage : report.stages) made += stage.made;
  return made;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string dem = argc > 1 ? argv[1] : "sample_data/jacksboro/dem.tif";
  const std::filesystem::path work = "resume_batch_work";
  std::filesystem::remove_all(work);

  pipeline::Registry stages;
  workflows::register_built_in_stages(stages);
  pipeline::Pipeline mapping(stages);
  mapping.add("load_dem", R"({"files": [")" + dem + R"("], "tile_cells": 128})")
      .add("find_mountain_tops", R"({"min_prominence": 50})")
      .add("join_mountain_tops")
      .add("measure_isolation")
      .add("map_mountain_tops");
  std::cout << pipeline::plan(mapping, {.work = work}).units.size() << " units of work\n";

  // Three shards, in any order, on any machine with access to the folder.
  for (const int index : {3, 1, 2}) {
    const pipeline::RunResult shard =
        pipeline::run(mapping, {.work = work, .shard = pipeline::Shard{index, 3}});
    std::cout << "shard " << index << " of 3 computed " << units_computed(shard.report) << " units\n";
  }

  const pipeline::RunResult again = pipeline::run(mapping, {.work = work});
  std::cout << "second run: computed " << units_computed(again.report) << ", found "
            << again.artifact<std::vector<Landmark>>("landmarks").size() << " landmarks\n";

  mapping.set("join_mountain_tops.base=lowest");  // re-runs this stage and its dependents only
  const pipeline::RunResult changed = pipeline::run(mapping, {.work = work});
  std::cout << "other option: computed " << units_computed(changed.report) << " units\n";
  return units_computed(again.report) == 0 && units_computed(changed.report) > 0 ? 0 : 1;
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return exit_code(error.code());
}
