// SPDX-License-Identifier: Apache-2.0
// A rover that knows neither its start nor the identity of any rock, localized by its log as
// `waymark localize rocks.gpkg site/log.jsonl -o track.csv --method pf --ids unknown --start none` does it.
#include <fstream>
#include <iostream>
#include <waymark/localization.hpp>
#include <waymark/map.hpp>
#include <waymark/testbed.hpp>
using namespace waymark;

namespace {

constexpr const char* kScenario = R"({
  "waymark_scenario": 1, "name": "A short drive", "crs": "local", "seed": 11,
  "ground": {"cell": 0.3},
  "relief": {"rms": 1, "max_wavelength": 250},
  "craters": {"density": 0.1, "min_diameter": 4, "max_diameter": 20},
  "rocks": {"k": 0.16, "min_diameter": 0.5, "max_diameter": 4},
  "camera": {"columns": 400, "rows": 400, "field_of_view": 50},
  "flights": [{"name": "view", "images": 1, "from_altitude": 250, "to_altitude": 250}],
  "drive": {"vehicle": "rover", "length": 150, "laser": {"every": 2, "step": 0.25}}})";

}  // namespace

int main() try {
  std::ofstream("drive.json") << kScenario;
  workflows::simulate({.scenario = "drive.json", .folder = "site"});

  workflows::ImportRequest map{.table = "site/truth/landmarks.csv", .map = "rocks.gpkg"};
  map.options.map_crs = "local";
  workflows::import_landmarks(map);

  workflows::LocalizeRequest request{.map = "rocks.gpkg", .log = "site/log.jsonl"};
  request.output = "track.csv";
  request.method = "pf";
  request.use_identities = false;
  request.start = "truth";
  const workflows::LocalizeResult result = workflows::localize(request);

  const localization::TrackScore score =
      workflows::evaluate(workflows::TrackEvaluation{.track = "track.csv", .truth = "site/log.jsonl"});
  std::cout << result.track.rows.size() << " poses, median error " << score.ate_median << " m, "
            << score.wrong_matches.value_or(0) << " wrong matches\n";
  return score.poses > 0 ? 0 : 1;
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return exit_code(error.code());
}
