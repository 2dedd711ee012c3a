// SPDX-License-Identifier: Apache-2.0
// Every reader of jobs, scenarios, stands and tables, given hundreds of damaged files.
#include "importers/tables/stand_outlines.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/table_landmarks.hpp"
#include "pipeline/forest/allometry.hpp"
#include "pipeline/forest/stand_volume.hpp"
#include "testbed/scenario.hpp"
#include "tests/support/mutated_files.hpp"
#include "workflows/mapping/make_map.hpp"
#include "workflows/registries.hpp"
#include "workflows/training/fit_allometry.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

TEST_F(MutatedFiles, OfJobs) {
  write("dem.tif", dem_bytes(folder_));
  check("job.json", R"({
"name": "Mountain tops",
"stages": [
  {"stage": "load_dem", "files": ["dem.tif"], "nodata": "unknown", "height_scale": 1.5, "tile_cells": 4096},
  {"stage": "find_mountain_tops", "min_prominence": 30},
  {"stage": "join_mountain_tops"},
  {"stage": "measure_isolation"},
  {"stage": "map_mountain_tops", "min_isolation": 10}
]
}
)",
        Content::text, 100, [&](const std::string& path) { make_map(load_job(path), {.check = true}); });
}

TEST_F(MutatedFiles, OfScenarios) {
  check("scenario.json",
        read_text(WAYMARK_SOURCE_DIR "/sample_data/mars_mission/scenario.json", "the scenario"),
        Content::text, 150,
        [](const std::string& path) { testbed::read_scenario(read_text(path, "the scenario"), path); });
}

TEST_F(MutatedFiles, OfStands) {
  check("stands.geojson", R"({"type": "FeatureCollection", "name": "stands",
"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}}, "features": [
{"type": "Feature", "properties": {"stand": "a", "species": "spruce"}, "geometry": {"type": "Polygon",
"coordinates": [[[440000, 5400000], [440100, 5400000], [440100, 5400100], [440000, 5400100], [440000, 5400000]]]}},
{"type": "Feature", "properties": {"stand": "b", "species": null}, "geometry": {"type": "MultiPolygon",
"coordinates": [[[[440200, 5400000], [440300, 5400000], [440300, 5400100], [440200, 5400000]]]]}}]}
)",
        Content::text, 150, [](const std::string& path) {
          importers::read_stand_outlines(path, "", Crs::from_text("EPSG:32632"));
        });
}

importers::TableImport rock_table(const char* crs, bool skip_bad_rows) {
  importers::TableImport how;
  how.type = "rock";
  how.map_crs = crs;
  how.skip_bad_rows = skip_bad_rows;
  return how;
}

TEST_F(MutatedFiles, OfTables) {
  check("rocks.csv", "x,y,z,radius,uid,confidence\n1,2,0,0.5,a,0.9\n3,4,0,0.6,b,0.8\n5,6,0,0.7,c,1\n",
        Content::text, 150, [](const std::string& path) {
          const auto table = importers::open_table(path, importers::TableFormat::by_name, "", "rock");
          importers::import_table(*table, all_types(), rock_table("local", true), [](Landmark&&) {});
        });
  check("rocks.geojson", R"({"type": "FeatureCollection", "features": [
{"type": "Feature", "properties": {"radius": 0.5}, "geometry": {"type": "Point", "coordinates": [8.1, 49.1, 100]}},
{"type": "Feature", "properties": {"radius": 0.7}, "geometry": {"type": "Point", "coordinates": [8.2, 49.2]}}]}
)",
        Content::text, 100, [](const std::string& path) {
          const auto table = importers::open_table(path, importers::TableFormat::by_name, "", "rock");
          importers::import_table(*table, all_types(), rock_table("EPSG:32632", false), [](Landmark&&) {});
        });
}

TEST_F(MutatedFiles, OfForestTables) {
  const auto text = [](const std::string& path) { return read_text(path, "this table"); };
  check("allometry.csv",
        "species,form,a,b,sigma,trees,rmse_cm\nall,height,1.2,0.9,0.2,100,3.5\n"
        "spruce,height_crown,0.5,0.8,0.2,50,3\n",
        Content::text, 100, [&](const std::string& path) { pipeline::parse_allometry(text(path), path); });
  check("volume.csv", "species,form_factor,form_factor_sd,mass_per_volume\nall,0.47,0.04,500\n",
        Content::text, 100, [&](const std::string& path) { pipeline::parse_volume(text(path), path); });
  check("recall.csv", "height_from,recall,sd\n0,0.3,0.1\n10,0.7,0.1\n20,0.9,0.05\n", Content::text, 100,
        [&](const std::string& path) { pipeline::parse_recall(text(path), path); });
  std::string measured = "species,plot,height,dbh,crown_diameter\n";
  for (int i = 0; i < 30; ++i)
    measured += "spruce,p" + std::to_string(i % 3) + "," + std::to_string(10 + i) + "," +
                std::to_string(12 + i) + ",4\n";
  check("measured.csv", measured, Content::text, 100,
        [](const std::string& path) { fit_allometry(AllometryRequest{.input = path}); });
}

}  // namespace
}  // namespace waymark::test
