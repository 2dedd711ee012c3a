// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/text_file.hpp"
#include "exporters/raster/image_file.hpp"
#include "exporters/raster/raster_file.hpp"
#include "exporters/staging_folder.hpp"
#include "testbed/landing/lit_terrain.hpp"
#include "testbed/scene_files.hpp"
#include "workflows/simulation/write_drive.hpp"
#include "workflows/simulation/write_forest.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

Scenario load_scenario(const SimulateRequest& request, const Callbacks& callbacks) {
  Scenario scenario = read_scenario(read_text(request.scenario, "the scenario"), request.scenario,
                                    [&](const std::string& warning) { callbacks.warning(warning); });
  scenario.seed = request.seed.value_or(scenario.seed);
  scenario.drive.seed = request.drive_seed.value_or(scenario.drive.seed);
  if ((request.drive_only || request.drive_seed) && !scenario.drive.on)
    throw Error(ErrorCode::usage, "the scenario has no section drive", request.scenario,
                "docs/reference/scenario.md describes it; {} stands for a drive with all defaults");
  return scenario;
}

Crs scenario_crs(const Scenario& scenario, const std::string& file) {
  const Crs crs = scenario.crs == "local" ? Crs::local() : Crs::from_text(scenario.crs);
  if (crs.kind() == CrsKind::geographic)
    throw Error(ErrorCode::usage, fmt::format("crs {} is geographic: its units are degrees", scenario.crs),
                file, "use a projected CRS or \"local\"");
  return crs;
}

void make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) fail_output(folder, failed.message());
}

/// Throws if the folder has images of an older scene, which would be taken for images of this one.
void check_other_images(const fs::path& images, const std::vector<Shot>& shots) {
  for (const auto& entry : fs::directory_iterator(images)) {
    const std::string name = entry.path().filename();
    if (std::ranges::none_of(shots, [&](const Shot& shot) { return shot.name == name; }))
      throw Error(ErrorCode::output, fmt::format("{} is not an image of this scene", name), images,
                  "write to another folder, or remove the older images");
  }
}

void write_site(const fs::path& folder, const Scenario& scenario, const Scene& scene,
                const std::vector<Shot>& shots, const Crs& crs) {
  for (const char* part : {"images", "truth"}) make_folder(folder / part);
  check_other_images(folder / "images", shots);
  const SimulatedDem dem = simulate_dem(scenario, scene);
  const double unit = crs.kind() == CrsKind::local ? 1 : crs.metres_per_unit();
  write_raster(folder / "dem.tif", dem.heights,
               {crs, dem.x0 / unit, dem.y0 / unit, dem.cell / unit, -dem.cell / unit});
  const LitTerrain ground(scene, scenario.exposure.sun);
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
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
}

SimulateResult simulate_forest(const SimulateRequest& request, const Scenario& scenario, const Crs& crs,
                               const Callbacks& callbacks) {
  const fs::path folder = request.folder;
  make_folder(folder / "truth");
  const Scene scene = make_forest_terrain(scenario);
  const WrittenForest forest = write_forest(folder, scenario, scene, crs);
  write_file(folder / "scenario.json", scenario_json(scenario));
  if (scenario.drive.on)
    callbacks.summary(write_drive(folder, scenario, scene, forest.trees, request.scenario) + "\n");
  callbacks.summary(fmt::format("{}: {}\n", request.folder, forest.summary));
  return {.trees = forest.trees.size()};
}

}  // namespace

SimulateResult simulate(const SimulateRequest& request, const Callbacks& callbacks) {
  Scenario scenario = load_scenario(request, callbacks);
  const Crs crs = scenario_crs(scenario, request.scenario);
  if (scenario.forest.on) return simulate_forest(request, scenario, crs, callbacks);
  const std::vector<Shot> shots = plan_shots(scenario);
  scenario.ground = size_site(scenario, shots);
  const Scene scene = make_scene(scenario.ground, static_cast<std::uint64_t>(scenario.seed));
  check_footprints(scene, shots);

  const fs::path folder = request.folder;
  if (request.drive_only) {
    make_folder(folder);
    const std::string drive = write_drive(folder, scenario, scene, {}, request.scenario);
    write_file(folder / "scenario.json", scenario_json(scenario));
    callbacks.summary(fmt::format("{}: {}\n", request.folder, drive));
    return {.rocks = scene.rocks.size(), .craters = scene.craters.size()};
  }
  write_site(folder, scenario, scene, shots, crs);
  if (scenario.drive.on) callbacks.summary(write_drive(folder, scenario, scene, {}, request.scenario) + "\n");
  callbacks.summary(fmt::format("{}: {:.0f} x {:.0f} m, {} images, {} rocks, {} craters\n", request.folder,
                                scenario.ground.width, scenario.ground.height, shots.size(),
                                scene.rocks.size(), scene.craters.size()));
  return {.images = shots.size(), .rocks = scene.rocks.size(), .craters = scene.craters.size()};
}

}  // namespace waymark
