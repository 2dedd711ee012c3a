// SPDX-License-Identifier: Apache-2.0
// Requests that are refused before any work is done, and what a library user sees of the rest.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "core/error.hpp"
#include "pipeline/engine/step_options.hpp"
#include "workflows/detection/detect.hpp"
#include "workflows/forest/inventory.hpp"
#include "workflows/localization/localize.hpp"
#include "workflows/mapping/make_map.hpp"
#include "workflows/parse_number.hpp"
#include "workflows/query/query_area.hpp"
#include "workflows/registries.hpp"
#include "workflows/training/train.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Returns the message of the usage error that a call throws.
template <class Call>
std::string usage_error(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

pipeline::Job mountain_top_job() {
  pipeline::Pipeline pipeline(all_stages());
  add_mountain_top_stages(pipeline, {"no_such_dem.tif"});
  return {"peaks", std::move(pipeline)};
}

TEST(ParseNumber, TakesTheWholeWordOnly) {
  EXPECT_EQ(parse_number("--x", "+2.5"), 2.5);
  EXPECT_EQ(parse_integer("--n", "-3"), -3);
  EXPECT_THAT(usage_error([] { parse_number("--x", "10m"); }), HasSubstr("--x must be a number, is '10m'"));
  EXPECT_THAT(usage_error([] { parse_number("--x", "nan"); }), HasSubstr("--x must be a number"));
  EXPECT_THAT(usage_error([] { parse_integer("--n", "1.5"); }), HasSubstr("--n must be a whole number"));
}

TEST(MakeMap, NeedsANameOrACheck) {
  EXPECT_THAT(usage_error([] { make_map(mountain_top_job(), {}); }), HasSubstr("the map needs a name"));
}

TEST(MakeMap, PartOfAJobNeedsAWorkFolder) {
  EXPECT_THAT(usage_error([] {
                make_map(mountain_top_job(), {.run = {.shard = pipeline::Shard{1, 2}}});
              }),
              HasSubstr("needs --work DIR"));
}

TEST(RenamedOptions, AreReadByTheirFormerNamesWithAWarning) {
  std::set<std::string> renamed;
  for (const std::string& stage : all_stages().names())
    for (const OptionRow& row : option_table(all_stages().at(stage))) {
      if (row.field.formerly.empty()) continue;
      const auto defaults = nlohmann::json::parse(options_as_json({row}));
      pipeline::Pipeline pipeline(all_stages());
      pipeline.add(stage, nlohmann::json{{row.field.formerly, defaults[row.name]}}.dump());
      pipeline.set(stage + "." + row.field.formerly + "=" + defaults[row.name].dump());
      EXPECT_THAT(pipeline.warnings(),
                  ElementsAre("stages[0]." + row.field.formerly + " was renamed: use " + row.name,
                              HasSubstr(stage + "." + row.field.formerly + " was renamed: use " + row.name)));
      renamed.insert(row.field.formerly);
    }
  EXPECT_THAT(renamed, ElementsAre("common_share", "edge_share", "least_crater", "least_diameter",
                                   "match_ground", "min_share", "most_images", "most_pixels"));
}

TEST(MakeMap, WarnsOfFormerNames) {
  pipeline::Job job = mountain_top_job();
  job.pipeline.add("check_sun", R"({"most_pixels": 100})");
  std::vector<std::string> warnings;
  const Callbacks callbacks{.message = [&](const Message& message) {
    if (message.kind == MessageKind::warning) warnings.push_back(message.text);
  }};
  EXPECT_THROW(make_map(job, {.map = "tops.gpkg", .check = true}, callbacks), Error);  // no such DEM
  EXPECT_THAT(warnings, ElementsAre("stages[5].most_pixels was renamed: use max_pixels"));
}

TEST(TreeStages, CanopyIsRastersOrPoints) {
  pipeline::Pipeline pipeline(all_stages());
  EXPECT_THAT(usage_error([&] { add_tree_stages(pipeline, {}); }), HasSubstr("no canopy is given"));
  EXPECT_THAT(usage_error([&] { add_tree_stages(pipeline, {.chm = {"a.tif"}, .las = {"a.las"}}); }),
              HasSubstr("--las is given together with rasters"));
  EXPECT_THAT(usage_error([&] { add_tree_stages(pipeline, {.dtm = {"a.tif"}}); }),
              HasSubstr("--dtm is given without --dsm or --las"));
}

TEST(Detect, UnknownKindNamesTheNearest) {
  DetectRequest request;
  request.kind = "rockz";
  EXPECT_THAT(usage_error([&] { detect(request); }), HasSubstr("did you mean 'rocks'?"));
}

TEST(Localize, MethodsAreListedAndUnknownOnesRefused) {
  EXPECT_THAT(localize_methods(), Contains("pf"));
  EXPECT_THAT(describe_localize_methods(), HasSubstr("odometry: "));
  EXPECT_THAT(usage_error([] { localize({.map = "map.gpkg", .log = "log.jsonl", .method = "gps"}); }),
              HasSubstr("localize has no method 'gps'"));
}

TEST(Localize, FiltersDoNotChangeMaps) {
  EXPECT_THAT(usage_error([] { localize({.map = "map.gpkg", .log = "log.jsonl", .write_map = "new.gpkg"}); }),
              HasSubstr("--method ekf does not change maps"));
}

TEST(Inventory, StandsOrGrid) {
  InventoryRequest request;
  request.map = "map.gpkg";
  request.stands = "stands.geojson";
  request.grid = 100;
  EXPECT_THAT(usage_error([&] { inventory(request); }), HasSubstr("--stands and --grid exclude each other"));
  request.stands.clear(), request.grid = 0, request.stands_layer = "compartments";
  EXPECT_THAT(usage_error([&] { inventory(request); }),
              HasSubstr("--stands-layer names a layer of --stands"));
}

TEST(Train, CratersTakeNoImages) {
  EXPECT_THAT(usage_error([] { train({.what = "craters", .images = {"a.tif"}}); }),
              HasSubstr("craters are trained on made scenes"));
}

TEST(Box, CrossesTheAntimeridian) {
  const Crs degrees = Crs::from_text("EPSG:4326");
  const geodb::MapQuery::Box box{170, -10, -170, 10};
  EXPECT_TRUE(inside(box, {{180, 0, 0}}, degrees));
  EXPECT_TRUE(inside(box, {{-175, 0, 0}}, degrees));
  EXPECT_FALSE(inside(box, {{160, 0, 0}}, degrees));
}

}  // namespace
}  // namespace waymark::test
