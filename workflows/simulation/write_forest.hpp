// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "testbed/forest/forest.hpp"
#include "testbed/scenario.hpp"
#include "testbed/scene.hpp"
namespace waymark::workflows {

/// Returns the terrain of a scenario's forest: its relief without craters, rocks, dunes and outcrops, some
/// metres wider than the forest.
testbed::Scene make_forest_terrain(const testbed::Scenario& scenario);

struct WrittenForest {
  std::vector<testbed::StandingTree> trees;
  std::string summary;  ///< for people, without \n
};

/// Plants the scenario's forest on the terrain, scans it from the air, and writes files into an existing
/// folder: dtm.tif, dsm.tif, chm.tif, points.las, stands.geojson, job.json and the truth tables.
WrittenForest write_forest(const std::filesystem::path& folder, const testbed::Scenario& scenario,
                           const testbed::Scene& scene, const Crs& crs);

}  // namespace waymark::workflows
