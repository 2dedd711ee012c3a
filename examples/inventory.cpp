// SPDX-License-Identifier: Apache-2.0
// A forest from its canopy model to figures by stand, as `waymark run` and `waymark inventory` give them.
#include <iomanip>
#include <iostream>
#include <waymark/forest.hpp>
#include <waymark/mapping.hpp>
#include <waymark/testbed.hpp>
using namespace waymark;

int main(int argc, char** argv) try {
  const std::string samples = argc > 1 ? argv[1] : "sample_data";

  // Canopy model and stands of a simulated forest; a job of your own names your files.
  workflows::simulate({.scenario = samples + "/forest/scenario.json", .folder = "forest"});
  if (!workflows::make_map(workflows::load_job("forest/job.json"), {.map = "trees.gpkg"}).written) return 1;

  workflows::InventoryRequest request;
  request.map = "trees.gpkg";
  request.stands = "forest/stands.geojson";
  request.output = "stands.csv";
  const workflows::InventoryResult result = inventory(request);

  for (const std::string& warning : result.warnings) std::cout << "warning: " << warning << '\n';
  std::cout << std::fixed << std::setprecision(1);
  for (const workflows::StandResult& stand : result.stands)
    std::cout << stand.stand.name << ": " << stand.figures.trees << " trees on " << stand.figures.hectares
              << " ha, " << stand.complete.volume.value << " +- " << stand.complete.volume.se << " m3/ha\n";
  return result.trees > 0 ? 0 : 1;
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return exit_code(error.code());
}
