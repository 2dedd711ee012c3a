// SPDX-License-Identifier: Apache-2.0
// A map of the mountain tops of a DEM, as `waymark peaks DEM -o mapping.gpkg --min-prominence 50` makes it.
#include <iostream>
#include <waymark/map.hpp>
#include <waymark/mapping.hpp>
using namespace waymark;

int main(int argc, char** argv) try {
  const std::string samples = argc > 1 ? argv[1] : "sample_data";

  pipeline::Pipeline pipeline(workflows::all_stages());
  workflows::add_mountain_top_stages(pipeline, {samples + "/jacksboro/dem.tif"});
  pipeline.set("load_dem.nodata=unknown").set("find_mountain_tops.min_prominence=50");
  const pipeline::Job job{"peaks", std::move(pipeline)};

  const workflows::Callbacks callbacks{.message = [](const workflows::Message& message) {
    if (message.kind == workflows::MessageKind::summary) std::cout << message.text;
  }};
  const workflows::MapResult made = workflows::make_map(job, {.map = "mapping.gpkg"}, callbacks);

  workflows::QueryRequest largest;
  largest.largest = "prominence";
  largest.limit = 3;
  for (const Landmark& top : workflows::query("mapping.gpkg", largest).landmarks)
    std::cout << top.uid << " at " << top.position.xyz.head<2>().transpose() << '\n';
  return made.written ? made.exit_code() : 1;
} catch (const Error& error) {
  std::cerr << error.what() << '\n';
  return exit_code(error.code());
}
