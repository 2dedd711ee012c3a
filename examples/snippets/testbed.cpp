// SPDX-License-Identifier: Apache-2.0
// Excerpts of the reference of waymark/testbed.hpp.
#include <array>
#include <fstream>
#include <iostream>
#include <waymark/map.hpp>
#include <waymark/testbed.hpp>
using namespace waymark;

namespace {

void make_site() {
  //! [simulate]
  std::ofstream("site.json") << R"({"waymark_scenario": 1, "crs": "local", "ground": {"cell": 0.5},
    "rocks": {"k": 0.1, "min_diameter": 0.8, "max_diameter": 5}, "camera": {"columns": 200, "rows": 200},
    "flights": [{"name": "view", "images": 1, "from_altitude": 150, "to_altitude": 150}]})";
  workflows::SimulateRequest request{.scenario = "site.json",
                                     .folder = "site"};  // as `waymark simulate site.json -o site`
  request.seed = 7;
  std::cout << workflows::simulate(request).rocks << " rocks\n";
  //! [simulate]
}

void compare() {
  workflows::ImportRequest map{.table = "site/truth/landmarks.csv", .map = "site.gpkg"};
  map.options.map_crs = "local";
  workflows::import_landmarks(map);
  //! [evaluate]
  const workflows::LandmarkEvaluation request{.result = "site.gpkg", .truth = "site/truth/landmarks.csv"};
  for (const auto& [type, score] : workflows::evaluate(request))
    std::cout << type << ": precision " << score.all.precision() << ", recall " << score.all.recall() << '\n';
  for (const exporters::QualityCheck& check : workflows::check_quality(request.result, request.truth)) {
    std::cout << check.type << ' ' << check.claim << " errs by " << check.expected_error << '\n';
    for (const exporters::ReliabilityBin& bin : check.bins)
      std::cout << bin.mean << " claimed, " << bin.right << " of " << bin.found << " right\n";
  }
  //! [evaluate]
}

void match() {
  //! [score]
  std::array<testbed::EvaluatedObject, 1> truth, found;  // in one unit, metres or pixels
  truth[0].at = {10, 20}, truth[0].diameter = 2;
  found[0].at = {10.2, 20.1}, found[0].diameter = 2.1;
  const testbed::Score result = score(found, truth, {.by = testbed::MatchRules::By::distance});
  std::cout << result.position_median << " off, F1 " << result.all.f1() << '\n';
  //! [score]
}

}  // namespace

int main() {
  for (const auto& step : {make_site, compare, match}) step();
}
