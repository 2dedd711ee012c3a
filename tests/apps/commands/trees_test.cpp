// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"
#include "tests/support/laz_writer.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Cones every 8 m, 10 to 19 m high, cells of 0.5 m.
MadeDem cones(double east = 0) {
  MadeDem chm{.columns = 300, .rows = 200, .geotransform = {500000, 0.5, 0, 5200000, 0, -0.5}};
  chm.height = [east](int column, int row) {
    const double x = 0.5 * column - east, y = 0.5 * row;
    const double i = std::floor(x / 8), j = std::floor(y / 8);
    const double top = 10 + std::fmod(3 * i + 5 * j + 1000, 10);
    return std::max(0.0, top - 4 * std::hypot(x - 8 * i - 4, y - 8 * j - 4));
  };
  return chm;
}

class Trees : public testing::Test {
 protected:
  Outcome trees(std::vector<std::string> words, const std::string& map = "trees.gpkg") {
    words.insert(words.begin(), {"trees", "-o", folder_ / map});
    return waymark(words);
  }
  std::string csv(const std::string& map = "trees.gpkg") {
    return waymark({"query", folder_ / map, "--format", "csv"}).out;
  }
  /// Everything in these layers, row by row, as GDAL sees it.
  std::string rows(const std::string& map = "trees.gpkg",
                   const std::vector<std::string>& layers = {"tree", "crown", "observation",
                                                             "tree_observation", "image"}) {
    std::string all;
    for (const std::string& layer : layers)
      all += bash("ogrinfo -ro -q -nomd '" + (folder_ / map) + "' " + layer).out;
    return all;
  }
  std::string chm() { return make_dem(folder_ / "chm.tif", cones()); }

  TempFolder folder_;
};

TEST_F(Trees, OfAFolderOfCompressedPoints) {
  LazFile west{.format = 1, .chunks = {{}}}, east{.format = 6, .chunks = {{}}};
  for (int i = 0; i < 80 * 80 * 4; ++i) {
    RawPoint p;
    const double x = 0.5 * (i % 160), y = 0.5 * (i / 160);
    const double above = 12 - 3 * std::hypot(std::fmod(x, 20) - 10, std::fmod(y, 20) - 10);
    p.at = {static_cast<int>(1000 * x), static_cast<int>(1000 * y),
            static_cast<int>(1000 * std::max(0.0, above))};
    p.classification = above > 0 ? 5 : 2, p.time = i;
    (x < 40 ? west : east).chunks[0].push_back(p);
  }
  const std::string folder = folder_ / "tiles";
  std::filesystem::create_directory(folder);
  write_text(folder + "/west.laz", laz_bytes(west));
  write_text(folder + "/east.copc.laz", copc_bytes(east, 3));
  ASSERT_EQ(trees({"--las", folder}).code, 0);
  MadeDem level{.columns = 100, .rows = 100, .geotransform = {499990, 1, 0, 5000090, 0, -1}};
  level.height = [](int, int) { return 0.0; };
  const Outcome above =
      trees({"--las", folder, "--dtm", make_dem(folder_ / "dtm.tif", level), "--crs", "local"}, "above.gpkg");
  ASSERT_EQ(above.code, 0) << above.err;
  EXPECT_EQ(json::parse(waymark({"query", folder_ / "above.gpkg", "--format", "json"}).out).size(), 16U);
  const json found = json::parse(waymark({"query", folder_ / "trees.gpkg", "--format", "json"}).out);
  EXPECT_EQ(found.size(), 16U);  // 20 m apart on 80 x 80 m
  EXPECT_THAT(trees({"--las", folder_ / "none.laz"}).err, HasSubstr("none.laz"));
}

TEST_F(Trees, ConesEndToEnd) {
  const Outcome made = trees({"--chm", chm(), "--preset", "conifer"});
  ASSERT_EQ(made.code, 0) << made.err;
  const json found = json::parse(waymark({"query", folder_ / "trees.gpkg", "--format", "json"}).out);
  EXPECT_EQ(found.size(), 19U * 13U);
  for (const json& tree : found) {
    EXPECT_GT(tree["height"], 7.5);  // those at the edge are cut
    EXPECT_GT(tree["crown_diameter"], 2.0);
    EXPECT_GT(tree["diameter"], 0.02);
    EXPECT_GT(tree["diameter_sd"], 0.1 * tree["diameter"].get<double>());  // that of the allometry
    EXPECT_TRUE(tree["diameter_q"].is_null());                             // one observation has no spread
  }
  EXPECT_EQ(waymark({"validate", folder_ / "trees.gpkg"}).code, 0);
}

TEST_F(Trees, DoNotDependOnTilesAndThreads) {
  const std::string file = chm();
  trees({"--chm", file});
  trees({"--chm", file, "--tile-cells", "64", "--threads", "1"}, "tiles.gpkg");
  trees({"--chm", file, "--tile-cells", "64", "--work", folder_ / "work"}, "work.gpkg");
  trees({"--chm", file, "--tile-cells", "64", "--work", folder_ / "work"}, "resumed.gpkg");
  const std::string once = rows();
  EXPECT_GT(once.size(), 19U * 13U * 500U);
  for (const char* map : {"tiles.gpkg", "work.gpkg", "resumed.gpkg"}) EXPECT_EQ(rows(map), once) << map;
}

TEST_F(Trees, OfOneSurveyAreThoseThatMergingGives) {
  ASSERT_EQ(trees({"--chm", chm(), "--tile-cells", "64"}).code, 0);
  const Outcome merged = trees({"--chm", chm(), "--flights"}, "merged.gpkg");
  ASSERT_EQ(merged.code, 0);
  EXPECT_THAT(merged.err, HasSubstr("merge_observations"));
  EXPECT_EQ(csv("merged.gpkg"), csv());
  EXPECT_EQ(rows("merged.gpkg", {"tree", "crown"}), rows("trees.gpkg", {"tree", "crown"}));
}

TEST_F(Trees, LeaveNothingButTheMap) {
  ASSERT_EQ(trees({"--chm", chm(), "--tile-cells", "64"}).code, 0);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    names.push_back(entry.path().filename());
  EXPECT_THAT(names, testing::UnorderedElementsAre("chm.tif", "trees.gpkg"));
}

TEST_F(Trees, FlightsAreMerged) {
  const std::string first = chm(), second = make_dem(folder_ / "later.tif", cones(0.3));
  ASSERT_EQ(trees({"--chm", first, second, "--flights"}).code, 0);
  const json found = json::parse(waymark({"query", folder_ / "trees.gpkg", "--format", "json"}).out);
  int both = 0;
  for (const json& tree : found) both += tree["seen"] == 2;
  EXPECT_GT(both, 190);
}

TEST_F(Trees, FlightsDoNotDependOnTilesAndThreads) {
  const std::string first = chm(), second = make_dem(folder_ / "later.tif", cones(0.3));
  const auto made = [&](const std::string& map, std::vector<std::string> words) {
    words.insert(words.begin(), {"--chm", first, second, "--flights"});
    EXPECT_EQ(trees(words, map).code, 0);
    return rows(map);
  };
  const std::string once = made("trees.gpkg", {});
  EXPECT_EQ(made("tiles.gpkg", {"--tile-cells", "64", "--threads", "1"}), once);
  EXPECT_EQ(made("work.gpkg", {"--tile-cells", "64", "--work", folder_ / "work"}), once);
  EXPECT_EQ(made("resumed.gpkg", {"--tile-cells", "64", "--work", folder_ / "work"}), once);
}

TEST_F(Trees, WrongUseIsExplained) {
  EXPECT_THAT(trees({}).err, HasSubstr("no canopy is given"));
  EXPECT_EQ(trees({}).code, 2);
  EXPECT_THAT(trees({"--dsm", chm()}).err, HasSubstr("--dsm is given without --dtm"));
  EXPECT_THAT(trees({"--chm", chm(), "--preset", "conifre"}).err, HasSubstr("did you mean 'conifer'"));
  EXPECT_THAT(trees({"--chm", chm(), "--las", "a.las"}).err, HasSubstr("leave out one or the other"));
  const Outcome missing = trees({"--chm", folder_ / "none.tif"});
  EXPECT_EQ(missing.code, 1);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "trees.gpkg"));
  MadeDem degrees = cones();
  degrees.crs = "EPSG:4326", degrees.geotransform = {10, 1e-5, 0, 45, 0, -1e-5};
  const Outcome refused = trees({"--chm", make_dem(folder_ / "degrees.tif", degrees)});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("is in degrees"));
}

TEST_F(Trees, AreDetectedInAnImageOfHeights) {
  const Outcome made = waymark({"detect", "trees", chm(), "-o", folder_ / "trees.csv"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(
      text_of(folder_ / "trees.csv"),
      StartsWith(
          "x,y,diameter,major,minor,angle,confidence,height,tree_diameter,crown_diameter,map_x,map_y\n"));
  const auto rows = [&](const std::string& least) {
    waymark({"detect", "trees", chm(), "-o", folder_ / "some.csv", "--min-confidence", least});
    return std::ranges::count(text_of(folder_ / "some.csv"), '\n');
  };
  EXPECT_EQ(rows("0"), std::ranges::count(text_of(folder_ / "trees.csv"), '\n'));
  EXPECT_EQ(rows("1"), 1);  // no top is certain
  EXPECT_EQ(waymark({"detect", "trees", chm(), "-o", folder_ / "trees.csv", "--method", "imagery"}).code, 2);
}

/// Brightness of bare ground of 360 x 240 m: rolling, with dark pits every 27 m.
MadeDem pits(int bands) {
  MadeDem picture{
      .columns = 600, .rows = 400, .bands = bands, .geotransform = {500000, 0.6, 0, 5200000, 0, -0.6}};
  picture.height = [](int column, int row) {
    const double x = 0.6 * column, y = 0.6 * row;
    const double i = std::floor(x / 9), j = std::floor(y / 9);
    const double away = std::hypot(x - 9 * i - 4.5, y - 9 * j - 4.5);
    const double pit = std::fmod(3 * i + 5 * j, 3) == 0 ? 70 * std::exp(-away * away / 4) : 0;
    return std::round(110 + 30 * std::sin(0.13 * x + 0.05 * y) * std::cos(0.11 * y) - pit);
  };
  picture.cell_type = GDT_Byte;
  picture.nodata = 255;
  return picture;
}

// Grey pictures of bare ground had trees of 0.99 (one band) and 0.58 (three).
TEST_F(Trees, AreNotSeenOnBareGround) {
  for (const int bands : {1, 3}) {
    const Outcome made = waymark({"detect", "trees", make_dem(folder_ / "pits.tif", pits(bands)), "-o",
                                  folder_ / "trees.csv", "--min-confidence", "0.5"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(std::ranges::count(text_of(folder_ / "trees.csv"), '\n'), 1) << bands << " bands";
    EXPECT_THAT(made.err, bands == 1 ? AllOf(HasSubstr("this band holds no heights above ground"),
                                             HasSubstr("are taller than 120 m"))
                                     : AllOf(HasSubstr("supposed crowns have the colour of vegetation"),
                                             HasSubstr("count as real")));
  }
}

TEST_F(Trees, OfAPictureAreDoubted) {
  const Outcome made = trees({"--chm", make_dem(folder_ / "pits.tif", pits(1))});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.out + made.err, HasSubstr("does it hold heights above ground"));
  EXPECT_THAT(trees({"--chm", chm()}).err, Not(HasSubstr("does it hold heights above ground")));
}

TEST_F(Trees, AreNotSeenInElevations) {
  MadeDem mountains = cones();
  mountains.height = [](int column, int row) { return 1500 + 3 * std::sin(0.1 * column) + 0.1 * row; };
  const Outcome made =
      waymark({"detect", "trees", make_dem(folder_ / "dem.tif", mountains), "-o", folder_ / "trees.csv"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("but heights of trees above ground are 3 to 120 m"));
  // Brightnesses of 16 bits, some of them dark.
  mountains.height = [](int, int row) { return 500.0 * row; };
  EXPECT_THAT(
      waymark({"detect", "trees", make_dem(folder_ / "grey.tif", mountains), "-o", folder_ / "trees.csv"})
          .err,
      HasSubstr("but heights of trees above ground are 3 to 120 m"));
}

TEST_F(Trees, TakeDiametersFromAFittedTable) {
  std::string plots = "plot,height,dbh\n";
  for (int i = 0; i < 60; ++i) {
    const double height = 8 + 0.2 * i;
    plots += std::to_string(i / 6) + "," + std::to_string(height) + "," +
             std::to_string(1.5 * (height - 1.3)) + "\n";
  }
  write_text(folder_ / "plots.csv", plots);
  const Outcome fit = waymark({"allometry", "fit", folder_ / "plots.csv", "-o", folder_ / "table.csv"});
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(text_of(folder_ / "table.csv"),
              AllOf(HasSubstr("held_out_rmse_cm"), HasSubstr("all,height,1.5,1,")));
  ASSERT_EQ(trees({"--chm", chm(), "--allometry", folder_ / "table.csv"}).code, 0);
  const json found = json::parse(waymark({"query", folder_ / "trees.gpkg", "--format", "json"}).out);
  for (const json& tree : found)
    EXPECT_NEAR(tree["diameter"], 0.015 * (tree["height"].get<double>() - 1.3), 1e-3);
}

}  // namespace
}  // namespace waymark::test
