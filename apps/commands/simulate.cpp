// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/simulate.hpp"
#include "apps/command.hpp"
#include "apps/console.hpp"

namespace waymark::apps {
namespace {

class Simulate final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "simulate",
        .group = Group::make,
        .summary = "Simulate a landing site, a forest, a street or a hall with known landmarks",
        .about =
            "Writes a folder with the DEM, the images, the camera file with the sun, a job that makes a map "
            "of them, and the truth to evaluate the map with. The same scenario and seed give the same "
            "bytes for any number of threads.\n\n"
            "With a section `forest` it makes a forest instead, as an airborne laser scanner measures it: "
            "dtm.tif, dsm.tif, chm.tif, points.las, stands.geojson, the job and the truth "
            "(docs/reference/forest_scenario.md).\n\n"
            "With a section `street` or `hall` it makes a robot's drive with a laser scanner through a "
            "street "
            "or the floor of a building: log.jsonl and the truth (docs/reference/town_scenario.md).\n\n"
            "The scenario is JSON; every field has a default: docs/reference/scenario.md.",
        .arguments = {file_word("SCENARIO.json", &request_.scenario, "What to make"),
                      Argument{"-o,--output", "DIR", &request_.folder, "Folder for the files; it may exist"}
                          .needed()
                          .offering(Offer::folder),
                      {"--seed", "N", &seed_, "Another site of the same kind; default: the scenario's seed"},
                      {"--drive-seed", "N", &drive_seed_, "Another drive on the same site"},
                      {"--drive-only", "", &request_.drive_only,
                       "Write the drive and its truth only, no DEM and no images"},
                      format_option(&format_)},
        .examples = {{"waymark simulate scenario.json -o landing",
                      "dem.tif, images, cameras.json, truth, job.json"},
                     {"waymark run landing/job.json -o landing.gpkg", "The map of it"},
                     {"waymark localize landing.gpkg landing/log.jsonl -o track.csv --ids unknown",
                      "The track of the rover of the scenario's section drive"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    if (seed_ >= 0) request_.seed = seed_;
    if (drive_seed_ >= 0) request_.drive_seed = drive_seed_;
    const workflows::SimulateResult made = workflows::simulate(request_, console_callbacks(session, format_));
    if (format_ == "json")
      print_result(result_keys(), {{"folder", request_.folder},
                                   {"images", std::int64_t(made.images)},
                                   {"rocks", std::int64_t(made.rocks)},
                                   {"craters", std::int64_t(made.craters)},
                                   {"trees", std::int64_t(made.trees)},
                                   {"town_landmarks", std::int64_t(made.landmarks)}});
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"folder", ResultKind::text, "Folder that was written"},
            {"images", ResultKind::integer, "Images rendered"},
            {"rocks", ResultKind::integer, "Rocks of the site"},
            {"craters", ResultKind::integer, "Craters of the site"},
            {"trees", ResultKind::integer, "Trees of the forest"},
            {"town_landmarks", ResultKind::integer, "Landmarks of the street or the hall"}};
  }

  std::string format_ = "text";
  workflows::SimulateRequest request_;
  std::int64_t seed_ = -1, drive_seed_ = -1;
};

}  // namespace

void register_command_simulate(CommandTable& commands);
void register_command_simulate(CommandTable& commands) {
  commands.add<Simulate>();
}

}  // namespace waymark::apps
