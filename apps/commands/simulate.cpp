// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/command.hpp"
#include "apps/log.hpp"
#include "apps/session.hpp"
#include "apps/write_drive.hpp"
#include "apps/write_forest.hpp"
#include "core/error.hpp"
#include "core/random.hpp"
#include "core/text_file.hpp"
#include "exporters/aside_folder.hpp"
#include "exporters/image_file.hpp"
#include "exporters/raster_file.hpp"
#include "testbed/landing/lit_ground.hpp"
#include "testbed/scene_files.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

// Images of an older scene in the folder would be taken for images of this one.
void check_strangers(const fs::path& images, const std::vector<Shot>& shots) {
  for (const auto& entry : fs::directory_iterator(images)) {
    const std::string name = entry.path().filename();
    if (std::none_of(shots.begin(), shots.end(), [&](const Shot& shot) { return shot.name == name; }))
      throw Error(ErrorCode::output, fmt::format("{} is not an image of this scene", name), images,
                  "write to another folder, or remove the older images");
  }
}

class Simulate final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "simulate",
        .group = Group::make,
        .summary = "Make a landing site or a forest whose every rock, crater or tree is known",
        .about =
            "Writes into a folder: the DEM, the images, the camera file with the sun, a job that makes a map "
            "of "
            "them, and the truth to judge the map by. The same scenario and seed give the same bytes, "
            "whatever the "
            "number of threads.\n\nWith a section `forest` it makes a forest instead, as a laser scanner "
            "sees it from "
            "the air: dtm.tif, dsm.tif, chm.tif, points.las, stands.geojson, the job and the truth "
            "(docs/forest_testbed.md).\n\nThe scenario is JSON; every field has a default: docs/testbed.md.",
        .arguments =
            {file_word("SCENARIO.json", &scenario_, "What to make"),
             Argument{"-o,--output", "DIR", &folder_, "Folder for the files; it may exist"}.needed().offering(
                 Offer::folder),
             {"--seed", "N", &seed_, "Another site of the same kind; default: the scenario's seed"},
             {"--drive-seed", "N", &drive_seed_, "Another drive on the same site"},
             {"--drive-only", "", &drive_only_, "Write the drive and its truth only, no DEM and no images"}},
        .examples = {
            {"waymark simulate scenario.json -o landing", "dem.tif, images, cameras.json, truth, job.json"},
            {"waymark run landing/job.json -o landing.gpkg", "The map of it"},
            {"waymark localize landing.gpkg landing/log.jsonl -o track.csv --ids unknown",
             "Where the rover of the scenario's section drive was"}}};
  }

  int run(const Session&) override {
    Scenario scenario = read_scenario(read_text(scenario_, "the scenario"), scenario_);
    if (seed_ >= 0) scenario.seed = seed_;
    if (drive_seed_ >= 0) scenario.drive.seed = drive_seed_;
    if ((drive_only_ || drive_seed_ >= 0) && !scenario.drive.on)
      throw Error(ErrorCode::usage, "the scenario has no section drive", scenario_,
                  "docs/rover.md describes it; {} stands for a drive with all defaults");
    const Crs crs = scenario.crs == "local" ? Crs::local() : Crs::from_text(scenario.crs);
    if (crs.kind() == CrsKind::geographic)
      throw Error(ErrorCode::usage, fmt::format("crs {} is geographic: its units are degrees", scenario.crs),
                  scenario_, "use a projected CRS or \"local\"");
    if (scenario.forest.on) return make_forest(scenario, crs);
    const std::vector<Shot> shots = plan_shots(scenario);
    scenario.ground = sized_for(scenario, shots);
    const auto seed = static_cast<std::uint64_t>(scenario.seed);
    const Scene scene = make_scene(scenario.ground, seed);
    check_footprints(scene, shots);

    const fs::path folder = folder_;
    if (drive_only_) {
      std::error_code failed;
      fs::create_directories(folder, failed);
      if (failed) fail_output(folder, failed.message());
      const std::string told = write_drive(folder, scenario, scene, {}, scenario_);
      write_file(folder / "scenario.json", scenario_json(scenario));
      say(fmt::format("{}: {}\n", folder_, told));
      return 0;
    }
    for (const char* part : {"images", "truth"}) {
      std::error_code failed;
      fs::create_directories(folder / part, failed);
      if (failed) fail_output(folder / part, failed.message());
    }
    check_strangers(folder / "images", shots);
    const GivenDem dem = given_dem(scenario, scene);
    const double unit = crs.kind() == CrsKind::local ? 1 : crs.metres_per_unit();
    write_raster(folder / "dem.tif", dem.heights,
                 {crs, dem.x0 / unit, dem.y0 / unit, dem.cell / unit, -dem.cell / unit});
    const LitGround ground(scene, scenario.exposure.sun);
    for (const Shot& shot : shots) {
      const Pixels image =
          render_view(scene, ground, camera_view(shot.view), scenario.exposure, named_seed(seed, shot.name));
      write_image(folder / "images" / shot.name, image, static_cast<int>(scenario.bits));
    }
    const TruthTables truth = truth_tables(scenario, scene, shots);
    write_file(folder / "cameras.json", camera_file(scenario, shots, false));
    write_file(folder / "job.json", job_file(scenario));
    write_file(folder / "scenario.json", scenario_json(scenario));
    write_file(folder / "truth/cameras.json", camera_file(scenario, shots, true));
    write_file(folder / "truth/landmarks.csv", truth.landmarks);
    write_file(folder / "truth/ignored.csv", truth.ignored);
    write_file(folder / "truth/detections.csv", truth.detections);
    const std::string told = scenario.drive.on ? write_drive(folder, scenario, scene, {}, scenario_) : "";
    if (!told.empty()) say(told + "\n");
    say(fmt::format("{}: {:.0f} x {:.0f} m, {} images, {} rocks, {} craters\n", folder_,
                    scenario.ground.width, scenario.ground.height, shots.size(), scene.rocks.size(),
                    scene.craters.size()));
    return 0;
  }

 private:
  int make_forest(const Scenario& scenario, const Crs& crs) {
    const fs::path folder = folder_;
    std::error_code failed;
    fs::create_directories(folder / "truth", failed);
    if (failed) fail_output(folder / "truth", failed.message());
    const Scene scene = forest_ground(scenario);
    const WrittenForest forest = write_forest(folder, scenario, scene, crs);
    write_file(folder / "scenario.json", scenario_json(scenario));
    if (scenario.drive.on) say(write_drive(folder, scenario, scene, forest.trees, scenario_) + "\n");
    say(fmt::format("{}: {}\n", folder_, forest.told));
    return 0;
  }

  std::string scenario_, folder_;
  std::int64_t seed_ = -1, drive_seed_ = -1;
  bool drive_only_ = false;
};

}  // namespace

void register_command_simulate(CommandTable& commands);
void register_command_simulate(CommandTable& commands) {
  commands.add<Simulate>();
}

}  // namespace waymark
