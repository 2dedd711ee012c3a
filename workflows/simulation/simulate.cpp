// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/output_error.hpp"
#include "core/random.hpp"
#include "core/text_file.hpp"
#include "exporters/las_file.hpp"
#include "exporters/raster/image_file.hpp"
#include "exporters/raster/raster_file.hpp"
#include "exporters/vector/track_file.hpp"
#include "geo/crs.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "testbed/drive/drive_log.hpp"
#include "testbed/landing/lit_terrain.hpp"
#include "testbed/scenario.hpp"
#include "testbed/scene_files.hpp"
#include "testbed/town/town_drive.hpp"
#include "testbed/town/town_survey.hpp"
#include "workflows/mapping/image_stages.hpp"
#include "workflows/simulation/route_drive.hpp"
#include "workflows/simulation/write_forest.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

testbed::Scenario load_scenario(const SimulateRequest& request, const Callbacks& callbacks) {
  testbed::Scenario scenario =
      testbed::read_scenario(read_text(request.scenario, "the scenario"), request.scenario,
                             [&](const std::string& warning) { callbacks.warning(warning); });
  scenario.seed = request.seed.value_or(scenario.seed);
  scenario.drive.seed = request.drive_seed.value_or(scenario.drive.seed);
  const bool town = scenario.street.on || scenario.hall.on;
  if ((request.drive_only || request.drive_seed) && !scenario.drive.on && !town)
    throw Error(ErrorCode::usage, "the scenario has no section drive", request.scenario,
                "docs/reference/scenario.md describes it; {} stands for a drive with all defaults");
  return scenario;
}

Crs scenario_crs(const testbed::Scenario& scenario, const std::string& file) {
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
void check_other_images(const fs::path& images, const std::vector<testbed::Shot>& shots) {
  if (!fs::is_directory(images)) return;
  for (const auto& entry : fs::directory_iterator(images)) {
    const std::string name = entry.path().filename();
    if (std::ranges::none_of(shots, [&](const testbed::Shot& shot) { return shot.name == name; }))
      throw Error(ErrorCode::output, fmt::format("{} is not an image of this scene", name), images,
                  "write to another folder, or remove the older images");
  }
}

/// Returns the job that maps the files of a landing; names are relative to its own folder.
std::string landing_job(const testbed::Scenario& scenario) {
  using JobJson = nlohmann::ordered_json;
  JobJson dem{{"stage", "load_dem"},
              {"files", {"dem.tif"}},
              {"nodata", "unknown"},
              {"height_sd", scenario.dem.height_sd}};
  if (scenario.crs == "local") dem["crs"] = "local";
  JobJson stages = JobJson::array(
      {dem, JobJson{{"stage", "load_images"}, {"files", {"images/*.png"}}, {"cameras", "cameras.json"}}});
  for (const std::string& stage : image_stages({})) stages.push_back({{"stage", stage}});
  return JobJson{{"name", scenario.name}, {"stages", stages}}.dump(2) + "\n";
}

void write_site(const fs::path& folder, const testbed::Scenario& scenario, const testbed::Scene& scene,
                const std::vector<testbed::Shot>& shots, const Crs& crs, const Callbacks& callbacks) {
  for (const char* part : {"images", "truth"}) make_folder(folder / part);
  const double unit = crs.kind() == CrsKind::local ? 1 : crs.metres_per_unit();
  const auto write_dem = [&](const char* name, const testbed::SimulatedDem& dem) {
    exporters::write_raster(folder / name, dem.heights,
                            {crs, dem.x0 / unit, dem.y0 / unit, dem.cell / unit, -dem.cell / unit});
  };
  write_dem("dem.tif", testbed::simulate_dem(scenario.dem, scene));
  if (scenario.orbital_dem.cell > 0)
    write_dem("orbital_dem.tif", testbed::simulate_dem(scenario.orbital_dem, scene, "orbital dem errors"));
  const testbed::LitTerrain ground(scene, scenario.exposure.sun);
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  pipeline::ProgressMeter meter(callbacks.progress, "render_images", static_cast<std::int64_t>(shots.size()));
  for (const testbed::Shot& shot : shots) {
    const Pixels image = testbed::render_view(scene, ground, testbed::view_of(shot), scenario.exposure,
                                              named_seed(seed, shot.name));
    exporters::write_image(folder / "images" / shot.name, image, static_cast<int>(scenario.bits));
    meter.add(1);
  }
  meter.finish();
  const testbed::TruthTables truth = testbed::truth_tables(scenario, scene, shots);
  write_file(folder / "cameras.json", testbed::camera_file(scenario, shots, false));
  write_file(folder / "job.json", landing_job(scenario));
  write_file(folder / "scenario.json", testbed::scenario_json(scenario));
  write_file(folder / "truth/cameras.json", testbed::camera_file(scenario, shots, true));
  write_file(folder / "truth/landmarks.csv", truth.landmarks);
  write_file(folder / "truth/ignored.csv", truth.ignored);
  write_file(folder / "truth/detections.csv", truth.detections);
}

// Writes log.jsonl, truth/track.csv, the track estimated while driving and drive.json. Returns a summary.
std::string write_route_drive(const fs::path& folder, const RouteDrive& drive) {
  const DriveReport& r = drive.report;
  write_file(folder / "log.jsonl", drive.log);
  write_file(folder / "truth/track.csv", drive.true_track);
  exporters::write_track_csv(folder / "track.csv", drive.track);
  write_file(folder / "drive.json", drive_report_json(r));
  return fmt::format(
      "drive along a route of {:.0f} m: {}; {:.0f} m in {:.0f} s, {} new routes, {} stops, worst sd {:.2f} "
      "m, "
      "worst error {:.2f} m{}",
      r.planned_length, r.reached ? "reached the goal" : "ended by " + r.ended, r.driven, r.seconds,
      r.replans, r.stops, r.worst_sd, r.worst_error,
      r.reached || r.events.empty() ? "" : "\n  " + r.events.back().reason);
}

// Makes the drive of a scenario and writes log.jsonl, truth/track.csv and, in a forest, truth/trees.csv and
// truth/felled.csv. A table of real trees is read relative to the scenario file. Returns a summary.
std::string write_drive(const fs::path& folder, const testbed::Scenario& scenario,
                        const testbed::Scene& scene, std::vector<testbed::StandingTree> trees,
                        const fs::path& scenario_file, const Callbacks& callbacks) {
  testbed::DriveSettings drive = scenario.drive;
  std::string& vehicle = drive.dynamics.vehicle;
  if (vehicle.ends_with(".json")) vehicle = scenario_file.parent_path() / vehicle;
  if (!drive.trees.empty()) {
    const fs::path table = scenario_file.parent_path() / drive.trees;
    const std::string text =
        read_text(table, "the table of trees", ErrorCode::input, "see drive.trees of the scenario");
    trees = testbed::trees_from_table(text, table, drive.stand, {scene.ground.east, scene.ground.north},
                                      scene.terrain);
  }
  const testbed::LogCrs place{scenario.crs,
                              scenario.crs == "local" ? 1 : Crs::from_text(scenario.crs).metres_per_unit()};
  make_folder(folder / "truth");
  if (drive.planned()) {
    const testbed::DriveWorld site = testbed::make_drive_site(drive, scene, std::move(trees), scene.seed);
    return write_route_drive(folder, drive_route(site, scene, place, scenario_file.parent_path(), callbacks));
  }
  const testbed::DriveWorld world = testbed::make_drive(drive, scene, std::move(trees), scene.seed);
  if (!world.mishap.empty()) {
    const localization::Pose2& at = world.steps.back().at.plane;
    callbacks.warning(fmt::format(
        "the drive ends after {:.0f} m and {:.0f} s: the {} is {} at {:.1f}, {:.1f}",
        world.steps.back().distance, world.steps.back().t, drive.vehicle, world.mishap, at.x, at.y));
  }
  write_file(folder / "log.jsonl", testbed::drive_log(world, place));
  write_file(folder / "truth/track.csv", testbed::true_track(world, place));
  if (!world.trees.empty()) {
    write_file(folder / "truth/trees.csv", testbed::standing_table(world, place));
    write_file(folder / "truth/felled.csv", testbed::felled_table(world, place));
  }
  return fmt::format("drive of a {}: {:.0f} m in {:.0f} s{}", drive.vehicle, world.steps.back().distance,
                     world.steps.back().t,
                     world.trees.empty()
                         ? ""
                         : fmt::format(", {} trees, {} felled", world.trees.size(), world.felled.size()));
}

/// Writes the files of a scene aside with `write`, and replaces an older scene by all of them together.
void write_scene(const fs::path& folder, const std::function<void(const fs::path& aside)>& write) {
  make_folder(folder);
  AtomicFileSet files(folder, folder / "scenario.json");
  try {
    write(files.path());
  } catch (const Error& error) {
    throw with_final_path(error, files.path(), folder);
  }
  files.commit();
}

SimulateResult simulate_forest(const SimulateRequest& request, const testbed::Scenario& scenario,
                               const Crs& crs, const Callbacks& callbacks) {
  const testbed::Scene scene = make_forest_terrain(scenario);
  WrittenForest forest;
  std::string drive;
  write_scene(request.folder, [&](const fs::path& folder) {
    make_folder(folder / "truth");
    forest = write_forest(folder, scenario, scene, crs);
    write_file(folder / "scenario.json", testbed::scenario_json(scenario));
    if (scenario.drive.on)
      drive = write_drive(folder, scenario, scene, forest.trees, request.scenario, callbacks) + "\n";
  });
  if (!drive.empty()) callbacks.summary(drive);
  callbacks.summary(fmt::format("{}: {}\n", request.folder, forest.summary));
  return {.trees = forest.trees.size()};
}

/// Writes the airborne laser survey of a street. Returns the number of returns.
std::size_t write_survey(const fs::path& file, const testbed::Town& town, const testbed::StreetModel& model,
                         std::uint64_t seed) {
  exporters::LasFile cloud(file, Crs::local(), 0, 0);
  std::size_t returns = 0;
  testbed::survey_town(town, model, seed, [&](std::span<const testbed::LaserReturn> row) {
    returns += row.size();
    for (const testbed::LaserReturn& r : row)
      cloud.add({.x = r.x, .y = r.y, .z = r.z, .number = r.number, .of = r.of, .kind = r.kind});
  });
  cloud.close();
  return returns;
}

/// Writes a street or a floor: the log and the truth. Without a section drive the robot is that of
/// town_settings().
SimulateResult simulate_town(const SimulateRequest& request, const testbed::Scenario& scenario,
                             const Callbacks& callbacks) {
  if (scenario.crs != "local")
    throw Error(ErrorCode::usage,
                fmt::format("crs is {}: a street or a hall is made in metres", scenario.crs),
                request.scenario, "remove crs, or write \"local\"");
  if (scenario.drive.dynamics.on)
    throw Error(ErrorCode::usage, "drive.dynamics is on, but the ground of a street or a hall is level",
                request.scenario, "remove it, or simulate a landing site or a forest");
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  const std::uint64_t drive_seed =
      scenario.drive.seed >= 0 ? static_cast<std::uint64_t>(scenario.drive.seed) : seed;
  const testbed::Town town = scenario.street.on ? testbed::plan_street(scenario.street, seed, drive_seed)
                                                : testbed::plan_hall(scenario.hall, seed, drive_seed);
  testbed::TownDrive drive;
  std::size_t returns = 0;
  write_scene(request.folder, [&](const fs::path& folder) {
    make_folder(folder / "truth");
    if (scenario.drive.on && scenario.drive.scanner.on) make_folder(folder / "points");
    drive = testbed::drive_through(
        town, scenario.drive.on ? scenario.drive : testbed::town_settings(), drive_seed,
        [&](const std::string& name, const std::string& bytes) { write_file(folder / name, bytes); });
    write_file(folder / "log.jsonl", drive.log);
    write_file(folder / "truth/track.csv", drive.track);
    write_file(folder / "truth/landmarks.csv", testbed::town_table(town));
    if (scenario.street.on && scenario.street.survey_pulses > 0)
      returns = write_survey(folder / "survey.las", town, scenario.street, seed);
    write_file(folder / "scenario.json", testbed::scenario_json(scenario));
  });
  callbacks.summary(fmt::format("{}: {} landmarks, a drive of {:.0f} m in {:.0f} s{}\n", request.folder,
                                town.landmarks.size(), drive.distance, drive.seconds,
                                returns ? fmt::format(", {} laser returns", returns) : ""));
  return {.landmarks = town.landmarks.size()};
}

}  // namespace

SimulateResult simulate(const SimulateRequest& request, const Callbacks& callbacks) {
  testbed::Scenario scenario = load_scenario(request, callbacks);
  const Crs crs = scenario_crs(scenario, request.scenario);
  if (scenario.drive.scanner.on && !scenario.street.on && !scenario.hall.on)
    throw Error(ErrorCode::usage, "drive.scanner is on: a 3-D scanner is simulated in streets and halls only",
                request.scenario, "remove it, or add a section street or hall");
  if (scenario.street.on || scenario.hall.on) return simulate_town(request, scenario, callbacks);
  if (scenario.forest.on) return simulate_forest(request, scenario, crs, callbacks);
  const std::vector<testbed::Shot> shots = testbed::plan_shots(scenario);
  scenario.ground = testbed::size_site(scenario, shots);
  const testbed::Scene scene =
      testbed::make_scene(scenario.ground, static_cast<std::uint64_t>(scenario.seed));
  testbed::check_footprints(scene, shots);

  std::string drive;
  const auto add_drive = [&](const fs::path& folder) {
    drive = write_drive(folder, scenario, scene, {}, request.scenario, callbacks);
    write_file(folder / "scenario.json", testbed::scenario_json(scenario));
  };
  if (request.drive_only) {
    write_scene(request.folder, add_drive);
    callbacks.summary(fmt::format("{}: {}\n", request.folder, drive));
    return {.rocks = scene.rocks.size(), .craters = scene.craters.size()};
  }
  check_other_images(fs::path(request.folder) / "images", shots);
  write_scene(request.folder, [&](const fs::path& folder) {
    write_site(folder, scenario, scene, shots, crs, callbacks);
    if (scenario.drive.on) add_drive(folder);
  });
  if (!drive.empty()) callbacks.summary(drive + "\n");
  callbacks.summary(fmt::format("{}: {:.0f} x {:.0f} m, {} images, {} rocks, {} craters\n", request.folder,
                                scenario.ground.width, scenario.ground.height, shots.size(),
                                scene.rocks.size(), scene.craters.size()));
  return {.images = shots.size(), .rocks = scene.rocks.size(), .craters = scene.craters.size()};
}

}  // namespace waymark::workflows
