// SPDX-License-Identifier: Apache-2.0
// Uses the installed package: prints the numbers of summits of a DEM and of boulder fields.
#include <iostream>
#include <waymark/map.hpp>
#include <waymark/mapping.hpp>

namespace consumer {
void register_consumer_types(waymark::TypeRegistry& types);
}

int main(int, char** argv) {
  using namespace waymark;
  pipeline::Registry stages;
  workflows::register_built_in_stages(stages);
  pipeline::Pipeline mapping(stages);
  mapping.add("load_dem", R"({"files": [")" + std::string(argv[1]) + R"("]})")
      .add("find_mountain_tops", R"({"min_prominence": 300})")
      .add("join_mountain_tops")
      .add("measure_isolation")
      .add("map_mountain_tops");

  geodb::MapContents map;
  register_landmark_types(map.types);
  consumer::register_consumer_types(map.types);
  const pipeline::RunResult result = pipeline::run(mapping);
  map.crs = result.artifact<DemHandle>("dem")->geometry().where.crs;
  map.landmarks = result.artifact<std::vector<Landmark>>("landmarks");
  geodb::write_map("consumer.gpkg", map, {.empty_tables = {"boulder_field"}});

  const geodb::MapStore store = geodb::MapStore::open("consumer.gpkg");
  std::cout << store.count("mountain_top") << " summits, " << store.count("boulder_field")
            << " boulder fields\n";
  return store.count("mountain_top") > 0 ? 0 : 1;
}
