// SPDX-License-Identifier: Apache-2.0
// A run shared between processes, and resumed: whatever lies in the work folder is not done again.
#include <filesystem>
#include <iostream>
#include <waymark/waymark.hpp>
using namespace waymark;

namespace {

std::int64_t units_made(const RunReport& report) {
  std::int64_t made = 0;
  for (const StageReport& stage : report.stages) made += stage.made;
  return made;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string dem = argc > 1 ? argv[1] : "sample_data/jacksboro/dem.tif";
  const std::filesystem::path work = "resume_batch_work";
  std::filesystem::remove_all(work);

  Registry stages;
  register_importer_stages(stages);
  register_pipeline_stages(stages);
  Pipeline mapping(stages);
  mapping.add("load_dem", R"({"files": [")" + dem + R"("], "tile_cells": 128})")
      .add("find_mountain_tops", R"({"min_prominence": 50})")
      .add("join_mountain_tops")
      .add("measure_isolation")
      .add("map_mountain_tops");
  std::cout << plan(mapping, {.work = work}).units.size() << " units of work\n";

  // Three shares, in any order, at any time, on any machine that sees the folder.
  for (const int index : {3, 1, 2}) {
    const RunResult share = run(mapping, {.work = work, .shard = Shard{index, 3}});
    std::cout << "share " << index << " of 3 made " << units_made(share.report) << " units\n";
  }

  const RunResult again = run(mapping, {.work = work});
  std::cout << "again: made " << units_made(again.report) << ", found "
            << again.artifact<std::vector<Landmark>>("landmarks").size() << " landmarks\n";

  mapping.set("join_mountain_tops.base=lowest");  // only what depends on it is made anew
  const RunResult changed = run(mapping, {.work = work});
  std::cout << "another base: made " << units_made(changed.report) << " units\n";
  return units_made(again.report) == 0 && units_made(changed.report) > 0 ? 0 : 1;
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return exit_code(error.code());
}
