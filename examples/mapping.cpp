// SPDX-License-Identifier: Apache-2.0
// A map of the mountain tops of a DEM, as `waymark peaks DEM -o mapping.gpkg --min-prominence 50` makes it.
#include <iostream>
#include <waymark/map.hpp>
#include <waymark/mapping.hpp>
using namespace waymark;

int main(int argc, char** argv) try {
  const std::string samples = argc > 1 ? argv[1] : "sample_data";

  Pipeline pipeline(all_stages());
  add_mountain_top_stages(pipeline, {samples + "/jacksboro/dem.tif"});
  pipeline.set("load_dem.nodata=unknown").set("find_mountain_tops.min_prominence=50");
  const Job job{"peaks", std::move(pipeline)};

  const Callbacks callbacks{.message = [](const Message& message) {
    if (message.kind == MessageKind::summary) std::cout << message.text;
  }};
  const MapResult made = make_map(job, {.map = "mapping.gpkg"}, callbacks);

  QueryRequest largest;
  largest.largest = "prominence";
  largest.limit = 3;
  for (const Landmark& top : query("mapping.gpkg", largest).landmarks)
    std::cout << top.uid << " at " << top.position.xyz.head<2>().transpose() << '\n';
  return made.written ? made.exit_code() : 1;
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return exit_code(error.code());
}
