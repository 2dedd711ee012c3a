// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "testbed/forest/forest.hpp"
#include "testbed/scenario.hpp"
#include "testbed/scene.hpp"
namespace waymark {

/// The ground a scenario's forest stands on: its relief, without craters, rocks, dunes and outcrops, some
/// metres wider than the forest.
Scene forest_ground(const Scenario& scenario);

struct WrittenForest {
  std::vector<StandingTree> trees;
  std::string told;  ///< a line for people
};

/// Plants the scenario's forest on the ground, flies over it, and writes dtm.tif, dsm.tif, chm.tif,
/// points.las, stands.geojson, job.json and the truth lists into a folder that is there.
WrittenForest write_forest(const std::filesystem::path& folder, const Scenario& scenario, const Scene& scene,
                           const Crs& crs);

}  // namespace waymark
