// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/write_drive.hpp"

#include <fmt/format.h>

#include "core/text_file.hpp"
#include "exporters/staging_folder.hpp"
#include "geo/crs.hpp"

namespace waymark::workflows {

std::string write_drive(const std::filesystem::path& folder, const testbed::Scenario& scenario,
                        const testbed::Scene& scene, std::vector<testbed::StandingTree> trees,
                        const std::filesystem::path& scenario_file) {
  const testbed::DriveSettings& drive = scenario.drive;
  if (!drive.trees.empty()) {
    const std::filesystem::path table = scenario_file.parent_path() / drive.trees;
    const std::string text =
        read_text(table, "the table of trees", ErrorCode::input, "see drive.trees of the scenario");
    trees = testbed::trees_from_table(text, table, drive.stand, {scene.ground.east, scene.ground.north},
                                      scene.terrain);
  }
  const testbed::DriveWorld world = testbed::make_drive(drive, scene, std::move(trees), scene.seed);
  const testbed::LogCrs place{scenario.crs,
                              scenario.crs == "local" ? 1 : Crs::from_text(scenario.crs).metres_per_unit()};
  std::error_code failed;
  std::filesystem::create_directories(folder / "truth", failed);
  if (failed) exporters::fail_output(folder / "truth", failed.message());
  exporters::write_file(folder / "log.jsonl", testbed::drive_log(world, place));
  exporters::write_file(folder / "truth/track.csv", testbed::true_track(world, place));
  if (!world.trees.empty()) {
    exporters::write_file(folder / "truth/trees.csv", testbed::standing_table(world, place));
    exporters::write_file(folder / "truth/felled.csv", testbed::felled_table(world, place));
  }
  return fmt::format("drive of a {}: {:.0f} m in {:.0f} s{}", drive.vehicle, world.steps.back().distance,
                     world.steps.back().t,
                     world.trees.empty()
                         ? ""
                         : fmt::format(", {} trees, {} felled", world.trees.size(), world.felled.size()));
}

}  // namespace waymark::workflows
