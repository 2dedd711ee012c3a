// SPDX-License-Identifier: Apache-2.0
// Maps the mountain tops of a DEM, writes the map and queries it.
#include <iostream>
#include <waymark/map.hpp>
#include <waymark/mapping.hpp>
using namespace waymark;

int main(int argc, char** argv) try {
  const std::string dem = argc > 1 ? argv[1] : "sample_data/jacksboro/dem.tif";

  pipeline::Registry stages;
  workflows::register_built_in_stages(stages);

  pipeline::Pipeline mapping(stages);
  mapping.add("load_dem", R"({"files": [")" + dem + R"("], "nodata": "unknown"})")
      .add("find_mountain_tops", R"({"min_prominence": 50})")
      .add("join_mountain_tops")
      .add("measure_isolation")
      .add("map_mountain_tops");
  const pipeline::RunResult result = pipeline::run(mapping);
  std::cout << result.report;  // per stage: in, out, rejected by reason, seconds

  geodb::MapContents map;
  register_landmark_types(map.types);
  map.crs = result.artifact<DemHandle>("dem")->geometry().where.crs;
  map.landmarks = result.artifact<std::vector<Landmark>>("landmarks");
  geodb::write_map("quickstart.gpkg", map);

  const geodb::MapStore store = geodb::MapStore::open("quickstart.gpkg");
  const std::size_t prominence = feature_index(store.types()[store.types().id("mountain_top")], "prominence");
  const geodb::MapQuery::Near around_jacksboro{-84.18, 36.33, 12'000_m};
  for (const Landmark& top :
       store.query({.near = around_jacksboro, .largest_first = "prominence", .limit = 3}))
    std::cout << top.uid << ": " << top.features[prominence].value << " m above its key saddle, "
              << store.distance(top, around_jacksboro.x, around_jacksboro.y) << " m away\n";
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return exit_code(error.code());
}
