// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <waymark/waymark.hpp>
#include "geodb/layers/layer_style.hpp"
#include "pipeline/engine/stage_pages.hpp"
#include "tests/plug_in/stations.hpp"
namespace waymark::test {

void register_test_types(TypeRegistry& types);
void register_test_stages(pipeline::Registry& stages);

namespace {

using testing::Contains;
using testing::HasSubstr;

pipeline::Registry all_stages() {
  pipeline::Registry stages;
  workflows::register_built_in_stages(stages);
  register_test_stages(stages);
  return stages;
}

TEST(PlugIn, TypeFromOutsideIsRegisteredWithTheBuiltInTypes) {
  TypeRegistry types;
  register_landmark_types(types);
  register_test_types(types);
  EXPECT_THAT(types.names(), Contains("weather_station"));
  EXPECT_THAT(types.names(), Contains("mountain_top"));
  EXPECT_THAT(geodb::qml_style(*types.find("weather_station")), HasSubstr("<qgis"));
}

TEST(PlugIn, StageFromOutsideHasItsPages) {
  const pipeline::Registry stages = all_stages();
  EXPECT_THAT(stages.names(), Contains("place_weather_stations"));
  EXPECT_THAT(pipeline::stage_as_markdown(stages.at("place_weather_stations")),
              HasSubstr("Lowest summit that gets a station"));
}

TEST(PlugIn, StageFromOutsideRunsInAJobAndIsCounted) {
  const pipeline::Registry stages = all_stages();
  const pipeline::Job job = pipeline::parse_job(R"({"name": "stations", "stages": [
      {"stage": "load_dem", "files": [")" WAYMARK_SOURCE_DIR R"(/sample_data/jacksboro/dem.tif"]},
      {"stage": "find_mountain_tops", "min_prominence": 100},
      {"stage": "join_mountain_tops"},
      {"stage": "measure_isolation"},
      {"stage": "map_mountain_tops"},
      {"stage": "place_weather_stations", "min_elevation": 900}]})",
                                                stages);
  const pipeline::RunResult result = pipeline::run(job.pipeline);
  const pipeline::Counts& counts = result.report.stages.back().counts;
  EXPECT_GT(counts.out, 0);
  EXPECT_GT(counts.rejected.at("too low"), 0);
  EXPECT_EQ(counts.in, counts.out + counts.rejected_total());
  EXPECT_EQ(std::ssize(result.artifact<Stations>("stations").uids), counts.out);
}

}  // namespace
}  // namespace waymark::test
