// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <filesystem>

#include "geo/dem_handle.hpp"
#include "importers/hash.hpp"
#include "importers/rasters/dem.hpp"
#include "importers/rasters/dem_codec.hpp"
#include "importers/rasters/nodata_policy.hpp"
#include "importers/stages.hpp"
#include "importers/tiling.hpp"
#include "pipeline/engine/runner.hpp"
#include "tests/importers/raster_maker.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const pipeline::Registry& stages() {
  static const pipeline::Registry registry = [] {
    pipeline::Registry made;
    register_importer_stages(made);
    return made;
  }();
  return registry;
}

pipeline::RunResult load(const std::string& options) {
  pipeline::Pipeline pipeline(stages());
  pipeline.add("load_dem", options);
  return pipeline::run(pipeline, {.hash_file = hash_file});
}

TEST(LoadDem, WritesTheDemAndItsTiles) {
  const auto file = write_raster({.path = "/vsimem/a.tif", .cells = random_terrain(4, 150, 100)});
  const pipeline::RunResult result =
      load(R"({"files": [")" + file + R"("], "tile_cells": 64, "nodata": "unknown"})");
  const DemHandle& dem = result.artifact<DemHandle>("dem");
  EXPECT_EQ(dem->nodata_policy(), NodataPolicy::unknown);
  EXPECT_EQ(dem->geometry().columns, 150);
  const auto& tiles = result.artifact<std::vector<pipeline::Tile>>("tiles");
  ASSERT_EQ(tiles.size(), 6u);
  EXPECT_EQ(tiles[5], (pipeline::Tile{5, 2, 1, {128, 64, 22, 36}, 5}));
  ASSERT_EQ(result.inputs.size(), 1u);
  EXPECT_EQ(result.inputs[0], hash_file(file));
}

TEST(LoadDem, RanksTilesByTheBlocksOfTheFiles) {
  const auto ranks = [](std::vector<std::string> options) {
    Grid<double> cells(1100, 300, 1.);
    cells(3, 3) = 2;
    const auto file =
        write_raster({.path = "/vsimem/wide.tif", .cells = cells, .options = std::move(options)});
    const pipeline::RunResult result = load(R"({"files": [")" + file + R"("], "tile_cells": 550})");
    std::vector<std::int64_t> all;
    for (const auto& tile : result.artifact<std::vector<pipeline::Tile>>("tiles")) all.push_back(tile.rank);
    return all;
  };
  EXPECT_THAT(ranks({"TILED=YES"}), ElementsAre(0, 1));
  EXPECT_THAT(ranks({"TILED=NO"}), ElementsAre(0, 0)) << "strips: a row of tiles reads them once";
}

TEST(LoadDem, PassesWarningsOn) {
  const auto file = write_raster({.path = "/vsimem/flat.tif", .cells = Grid<double>(4, 4, 3)});
  const pipeline::RunResult result = load(R"({"files": [")" + file + R"("]})");
  ASSERT_EQ(result.report.stages.size(), 1u);
  EXPECT_THAT(result.report.stages[0].warnings, ElementsAre(HasSubstr("every cell has the height 3 m")));
}

TEST(LoadDem, NeedsAFile) {
  EXPECT_THAT(message_of([] { load("{}"); }), HasSubstr("no DEM is given"));
}

TEST(LoadDem, ChecksItsOptions) {
  EXPECT_THAT(message_of([] { load(R"({"files": ["a.tif"], "tile_cells": 10})"); }),
              HasSubstr("[64, 16384]"));
  EXPECT_THAT(message_of([] { load(R"({"files": ["a.tif"], "nodata": "sea"})"); }), HasSubstr("ocean"));
}

TEST(DemCodec, ReopensTheSameDem) {
  const auto file =
      write_raster({.path = "/vsimem/a.tif", .cells = dem_art("1 . 3"), .crs = "", .nodata = -1});
  const DemHandle dem =
      import_dem({.files = {file}, .nodata = NodataPolicy::fill, .crs = "EPSG:32611", .height_sd = 2});
  const std::string bytes = pipeline::Codec<DemHandle>::encode(dem);
  const DemHandle again = pipeline::Codec<DemHandle>::decode(bytes);
  EXPECT_EQ(again->read({0, 0, 3, 1}), dem_art("1 2 3"));
  EXPECT_EQ(again->geometry().where.crs.id(), "EPSG:32611");
  EXPECT_EQ(again->height_sd(), 2);
  EXPECT_EQ(pipeline::Codec<DemHandle>::encode(again), bytes);
}

TEST(DemCodec, CannotKeepADemThatIsNotOnFiles) {
  EXPECT_THROW(pipeline::Codec<DemHandle>::encode(std::make_shared<MemoryDem>(dem_art("1 2"))),
               std::logic_error);
}

TEST(TilesOf, CoverTheGridOnceRowByRow) {
  for (const std::int64_t side : {1, 3, 64, 100}) {
    Grid<int> times(10, 7);
    std::int64_t index = 0;
    for (const pipeline::Tile& tile : tiles_of(10, 7, side)) {
      EXPECT_EQ(tile.index, index++);
      EXPECT_EQ(tile.cells.column, tile.column * side);
      for (std::int64_t row = tile.cells.row; row < tile.cells.end_row(); ++row)
        for (std::int64_t column = tile.cells.column; column < tile.cells.end_column(); ++column)
          ++times(column, row);
    }
    EXPECT_THAT(times.cells(), ::testing::Each(1)) << side;
  }
}

TEST(NodataPolicy, NamesComeBack) {
  for (const std::string& name : nodata_policy_names()) EXPECT_EQ(to_string(nodata_policy(name)), name);
  EXPECT_THAT(message_of([] { nodata_policy("oceans"); }),
              AllOf(HasSubstr("there is no no-data policy 'oceans'"), HasSubstr("did you mean 'ocean'?")));
}

}  // namespace
}  // namespace waymark::test
