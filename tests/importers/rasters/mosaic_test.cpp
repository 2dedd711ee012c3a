// SPDX-License-Identifier: Apache-2.0
// Several files as one DEM, and grids that cover all longitudes.
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <thread>

#include "importers/rasters/dem.hpp"
#include "importers/rasters/mosaic.hpp"
#include "tests/importers/raster_maker.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// One-degree cells, the first centred on (lon, lat).
std::string degrees_file(const std::string& name, double lon, double lat, const Grid<double>& cells) {
  return write_raster({.path = "/vsimem/" + name,
                       .cells = cells,
                       .transform = centred_on(lon, lat, 1),
                       .crs = "EPSG:4326",
                       .nodata = -32768});
}

TEST(Mosaic, FilesThatTouchBecomeOneGrid) {
  const auto west = degrees_file("west.tif", 10, 50, dem_art("1 2 / 3 4"));
  const auto east = degrees_file("east.tif", 12, 49, dem_art("5 6 / 7 8"));
  const auto dem = import_dem({.files = {west, east}});
  EXPECT_EQ(all_heights(*dem), dem_art("1 2 . . / 3 4 5 6 / . . 7 8"));
  EXPECT_EQ(dem->geometry().where.x0, 10);
  EXPECT_EQ(dem->geometry().where.y0, 50);
  EXPECT_EQ(all_heights(*import_dem({.files = {east, west}})), all_heights(*dem))
      << "order matters only where files overlap";
}

TEST(Mosaic, TheFirstFileWinsWhereItHasData) {
  const auto first = degrees_file("first.tif", 10, 50, dem_art("1 2 / 3 ."));
  const auto second = degrees_file("second.tif", 11, 50, dem_art("2 9 / 8 7"));
  EXPECT_EQ(all_heights(*import_dem({.files = {first, second}})), dem_art("1 2 9 / 3 8 7"));
}

TEST(Mosaic, ReportsSeamsThatDisagree) {
  const auto first = degrees_file("first.tif", 10, 50, dem_art("1 2 / 3 4 / 5 ."));
  const auto second = degrees_file("second.tif", 11, 50, dem_art("2 9 / 8 7 / 6 6"));
  EXPECT_THAT(
      import_dem({.files = {first, second}})->warnings(),
      ElementsAre("/vsimem/first.tif and /vsimem/second.tif disagree in 1 of 2 shared cells, by up to 4 m at "
                  "(11.000000, 49.000000); the first one has priority"));
}

TEST(Mosaic, SeamsThatAgreeGiveNoWarning) {
  const auto first = degrees_file("first.tif", 10, 50, dem_art("1 2 / 3 4"));
  const auto second = degrees_file("second.tif", 11, 50, dem_art("2 9 / 4 7"));
  EXPECT_THAT(import_dem({.files = {first, second}})->warnings(), IsEmpty());
}

TEST(Mosaic, EachFileHasItsOwnNoDataAndScale) {
  const auto metres = degrees_file("metres.tif", 10, 50, dem_art("1 ."));
  const auto tenths = write_raster({.path = "/vsimem/tenths.tif",
                                    .cells = dem_art("30 ."),
                                    .type = GDT_Float32,
                                    .transform = centred_on(12, 50, 1),
                                    .crs = "EPSG:4326",
                                    .nodata = 0,
                                    .scale = 0.1});
  const auto heights = all_heights(*import_dem({.files = {metres, tenths}}));
  EXPECT_EQ(heights(1, 0), kNoHeight);
  EXPECT_NEAR(heights(2, 0), 3, 1e-12);
  EXPECT_EQ(heights(3, 0), kNoHeight);
}

TEST(Mosaic, JoinsAcrossTheAntimeridian) {
  const auto east = degrees_file("east.tif", 178.5, 10, dem_art("1 2"));
  const auto west = degrees_file("west.tif", -179.5, 10, dem_art("3 4"));
  const auto dem = import_dem({.files = {west, east}});
  EXPECT_EQ(all_heights(*dem), dem_art("1 2 3 4"));
  EXPECT_EQ(dem->geometry().where.x0, 178.5);
}

TEST(Mosaic, LeavesFilesOnOneSideWhereTheyAre) {
  const auto a = degrees_file("a.tif", -10.5, 10, dem_art("1 2"));
  const auto b = degrees_file("b.tif", 20.5, 10, dem_art("3 4"));
  const auto dem = import_dem({.files = {b, a}});
  EXPECT_EQ(dem->geometry().where.x0, -10.5);
  EXPECT_EQ(dem->geometry().columns, 33);
}

TEST(Mosaic, GoesRoundTheWorldInTiles) {
  std::vector<std::string> files;
  for (int tile = 0; tile < 4; ++tile)
    files.push_back(degrees_file("tile" + std::to_string(tile) + ".tif", -179.5 + 90 * tile, 0.5,
                                 Grid<double>(90, 1, tile)));
  const auto dem = import_dem({.files = files});
  EXPECT_EQ(dem->geometry().columns, 360);
  EXPECT_TRUE(dem->geometry().wraps);
  EXPECT_EQ(dem->geometry().where.x0, -179.5);
  EXPECT_EQ(dem->read({359, 0, 3, 1}), dem_art("3 0 0"));
}

Grid<double> global(std::int64_t columns) {
  Grid<double> cells(columns, 4);
  for (std::int64_t row = 0; row < 4; ++row)
    for (std::int64_t column = 0; column < columns; ++column)
      cells(column, row) = static_cast<double>(10 * row + column % 8);
  return cells;
}

// 8 x 4 cells of 45 degrees.
std::string global_file(std::int64_t columns, const std::string& crs = "IAU_2015:49900") {
  return write_raster({.path = "/vsimem/global.tif",
                       .cells = global(columns),
                       .transform = GeoTransform{0, 45, 0, 90, 0, -45},
                       .crs = crs});
}

TEST(GlobalGrid, WrapsAndReachesThePoles) {
  const auto dem = import_dem({.files = {global_file(8)}});
  const GridGeometry& grid = dem->geometry();
  EXPECT_TRUE(grid.wraps && grid.north_pole && grid.south_pole);
  EXPECT_EQ(dem->read({-2, 1, 4, 1}), dem_art("16 17 10 11"));
  EXPECT_EQ(dem->read({6, 3, 4, 2}), dem_art("36 37 30 31 / . . . ."));
  EXPECT_EQ(dem->read({-9, 0, 3, 1}), dem_art("7 0 1"));
  EXPECT_EQ(dem->read({7, 0, 18, 1}), dem_art("7 0 1 2 3 4 5 6 7 0 1 2 3 4 5 6 7 0"));
}

TEST(GlobalGrid, DropsTheColumnThatRepeatsTheFirst) {
  const auto dem = import_dem({.files = {global_file(9)}});
  EXPECT_EQ(dem->geometry().columns, 8);
  EXPECT_TRUE(dem->geometry().wraps);
  EXPECT_EQ(dem->read({7, 0, 2, 1}), dem_art("7 0"));
}

TEST(GlobalGrid, LessThanATurnDoesNotWrap) {
  EXPECT_FALSE(import_dem({.files = {global_file(7)}})->geometry().wraps);
}

TEST(GlobalGrid, WrapsInACylindricalProjectionToo) {
  const double turn = 2 * 3396190 * 3.14159265358979323846;
  const auto file = write_raster({.path = "/vsimem/global.tif",
                                  .cells = global(8),
                                  .transform = GeoTransform{-turn / 2, turn / 8, 0, turn / 4, 0, -turn / 8},
                                  .crs = "IAU_2015:49910"});
  const GridGeometry grid = import_dem({.files = {file}})->geometry();
  EXPECT_TRUE(grid.wraps && grid.north_pole && grid.south_pole);
}

TEST(GlobalGrid, UtmDoesNotWrap) {
  const auto file = write_raster(
      {.cells = Grid<double>(2000, 3, 1), .transform = GeoTransform{0, 25000, 0, 4000000, 0, -25000}});
  EXPECT_FALSE(import_dem({.files = {file}})->geometry().wraps);
}

std::string complaint_about_both(const std::string& a, const std::string& b) {
  return message_of([&] { import_dem({.files = {a, b}}); });
}

TEST(BadMosaic, DifferentCrs) {
  const auto a = degrees_file("a.tif", 10, 50, dem_art("1 2"));
  const auto b = write_raster({.path = "/vsimem/b.tif", .cells = dem_art("1 2")});
  EXPECT_THAT(complaint_about_both(a, b),
              AllOf(HasSubstr("the files are in different coordinate systems: EPSG:4326 and EPSG:32633"),
                    HasSubstr("/vsimem/a.tif and /vsimem/b.tif"),
                    HasSubstr("gdalwarp -t_srs 'EPSG:4326' '/vsimem/b.tif'")));
}

TEST(BadMosaic, DifferentResolution) {
  const auto a = degrees_file("a.tif", 10, 50, dem_art("1 2"));
  const auto b = write_raster({.path = "/vsimem/b.tif",
                               .cells = dem_art("1 2 / 3 4"),
                               .transform = GeoTransform{11.2, 0.5, 0, 50.5, 0, -0.5},
                               .crs = "EPSG:4326"});
  EXPECT_THAT(
      complaint_about_both(a, b),
      AllOf(HasSubstr("cells of different size: 1 x 1 and 0.5 x 0.5"),
            HasSubstr("gdalwarp -r bilinear -tr 1 1 -te 10.5 49.5 12.5 50.5 '/vsimem/b.tif' aligned.tif")));
}

TEST(BadMosaic, NotOnOneGrid) {
  const auto a = degrees_file("a.tif", 10, 50, dem_art("1 2"));
  const auto b = degrees_file("b.tif", 12.25, 50, dem_art("1 2"));
  EXPECT_THAT(complaint_about_both(a, b),
              AllOf(HasSubstr("do not lie on one grid: they are 0.250 columns and 0.000 rows apart"),
                    HasSubstr("-te 11.5 49.5 14.5 50.5")));
}

// Three files that overlap, holed, in blocks of 16 x 16 and in strips.
std::shared_ptr<const ImportedDem> patchwork(NodataPolicy policy, std::int64_t memory) {
  std::vector<std::string> files;
  for (unsigned i = 0; i < 3; ++i)
    files.push_back(write_raster(
        {.path = "/vsimem/patch" + std::to_string(i) + ".tif",
         .cells = random_terrain(100 + i, 40, 35),
         .transform = centred_on(10 + 25.0 * i, 50 - 9.0 * i, 1),
         .crs = "EPSG:4326",
         .nodata = -32768,
         .options = i == 2 ? std::vector<std::string>{}
                           : std::vector<std::string>{"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"}}));
  return import_dem({.files = files, .nodata = policy, .memory_bytes = memory});
}

RC_GTEST_PROP(Mosaic, AnyWindowGivesTheSameCells, ()) {
  static const auto dem = patchwork(NodataPolicy::ocean, 4096);  // a cache of a few blocks, always too small
  static const HeightWindow whole = all_heights(*dem);
  const Window window{*rc::gen::inRange(-5, 100), *rc::gen::inRange(-5, 60), *rc::gen::inRange(1, 60),
                      *rc::gen::inRange(1, 40)};
  const HeightWindow heights = dem->read(window);
  for (std::int64_t row = 0; row < window.rows; ++row)
    for (std::int64_t column = 0; column < window.columns; ++column) {
      const std::int64_t c = window.column + column, r = window.row + row;
      RC_ASSERT(heights(column, row) == (whole.contains(c, r) ? whole(c, r) : kNoHeight));
    }
}

TEST(Mosaic, ManyThreadsReadTheSame) {
  const auto dem = patchwork(NodataPolicy::ocean, 4096);
  const HeightWindow whole = all_heights(*dem);
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (std::size_t thread = 0; thread < wrong.size(); ++thread)
    threads.emplace_back([&, thread] {
      for (int i = 0; i < 50; ++i) wrong[thread] += all_heights(*dem) == whole ? 0 : 1;
    });
  for (auto& thread : threads) thread.join();
  EXPECT_THAT(wrong, ::testing::Each(0));
}

// Returns a block of 100 bytes that holds its number; counts how often it is decoded.
class BlockCacheTest : public testing::Test {
 protected:
  double decode(BlockCache& cache, std::uint64_t block, std::uint32_t file = 0) {
    const auto found = cache.get({file, block}, [&] {
      ++decoded;
      return Block{std::vector<double>(100 / sizeof(double) + 1, static_cast<double>(block))};
    });
    return std::get<std::vector<double>>(found->cells)[0];
  }
  int decoded = 0;
};

TEST_F(BlockCacheTest, DecodesOnce) {
  BlockCache cache(1000);
  EXPECT_EQ(decode(cache, 7), 7);
  EXPECT_EQ(decode(cache, 7), 7);
  EXPECT_EQ(decoded, 1);
}

TEST_F(BlockCacheTest, DistinguishesFiles) {
  BlockCache cache(1000);
  decode(cache, 7, 0);
  decode(cache, 7, 1);
  EXPECT_EQ(decoded, 2);
}

TEST_F(BlockCacheTest, DropsWhatWasUsedLongestAgo) {
  BlockCache cache(220);  // two blocks
  decode(cache, 1);
  decode(cache, 2);
  decode(cache, 1);
  decode(cache, 3);  // 2 goes
  decode(cache, 1);
  EXPECT_EQ(decoded, 3);
  decode(cache, 2);
  EXPECT_EQ(decoded, 4);
}

TEST_F(BlockCacheTest, ABlockLargerThanTheCacheIsStillServed) {
  BlockCache cache(1);
  EXPECT_EQ(decode(cache, 1), 1);
  EXPECT_EQ(decode(cache, 2), 2);
}

}  // namespace
}  // namespace waymark::test
