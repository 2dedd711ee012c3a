// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"
#include "tests/pipeline/buildings/made_town.hpp"
#include "tests/support/laz_writer.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

/// A scanned town as LAZ; `unit` is metres per unit of the file.
LazFile file_of(const MadeTown& town, const ScanRules& scan, std::uint64_t seed, double unit = 1) {
  LazFile laz{.format = 6, .chunks = {{}}};
  for (const TownReturn& p : scan_town(town, scan, seed)) {
    RawPoint raw;
    const auto steps = [&](double metres) {
      return static_cast<std::int32_t>(std::lround(1000 * metres / unit));
    };
    raw.at = {steps(p.x), steps(p.y), steps(p.z)};
    raw.classification = p.classification, raw.number = p.number, raw.returns = p.of;
    laz.chunks[0].push_back(raw);
  }
  return laz;
}

class Buildings : public testing::Test {
 protected:
  Outcome buildings(std::vector<std::string> words, const std::string& map = "town.gpkg") {
    words.insert(words.begin(), {"buildings", "-o", folder_ / map});
    return waymark(words);
  }
  json of(const std::string& type, const std::string& map = "town.gpkg") {
    const Outcome found = waymark({"query", folder_ / map, "--type", type, "--format", "json"});
    return found.code == 0 ? json::parse(found.out) : json::array();
  }
  std::string rows(const std::string& map) {
    std::string all;
    for (const char* layer : {"building", "wall", "wall_corner", "pole", "tree", "footprint", "observation"})
      all += bash("ogrinfo -ro -q -nomd '" + (folder_ / map) + "' " + layer).out;
    return all;
  }
  std::string write(const LazFile& laz, const std::string& name = "town.laz") {
    write_text(folder_ / name, laz_bytes(laz));
    return folder_ / name;
  }

  TempFolder folder_;
};

TEST_F(Buildings, OfPointsHaveOutlinesWallsAndCorners) {
  const MadeTown town = made_town(201, 72);
  const Outcome made = buildings({"--las", write(file_of(town, {.density = 16}, 1))});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(of("building").size(), town.houses.size());
  EXPECT_GE(of("wall").size(), 3 * town.houses.size());
  EXPECT_GE(of("wall_corner").size(), 4 * town.houses.size());
  EXPECT_GE(of("pole").size(), 1U);
  for (const json& house : of("building")) {
    const Eigen::Vector2d at(house["x"].get<double>() - 500000, house["y"].get<double>() - 5000000);
    EXPECT_TRUE(std::ranges::any_of(town.houses, [&](const House& h) { return (h.at - at).norm() < 4; }));
    EXPECT_GT(house["confidence"], 0.3);
  }
  const std::string outlines = bash("ogrinfo -ro -q -nomd '" + (folder_ / "town.gpkg") + "' footprint").out;
  EXPECT_THAT(outlines, AllOf(HasSubstr("POLYGON"), HasSubstr("roof (String) = flat"), HasSubstr("gabled")));
  EXPECT_EQ(waymark({"validate", folder_ / "town.gpkg"}).code, 0);
}

TEST_F(Buildings, DoNotDependOnTilesThreadsAndTheOrderOfFiles) {
  const MadeTown town = made_town(202, 72);
  LazFile all = file_of(town, {.density = 14}, 1), west = all, east = all;
  west.chunks = {{}}, east.chunks = {{}};
  for (const RawPoint& p : all.chunks[0]) (p.at[0] < 36000 ? west : east).chunks[0].push_back(p);
  std::ranges::reverse(west.chunks[0]);
  const std::string file = write(all), a = write(west, "west.laz"), b = write(east, "east.laz");
  ASSERT_EQ(buildings({"--las", file, "--trees", "--max-extent", "40"}).code, 0);
  ASSERT_EQ(
      buildings({"--las", file, "--trees", "--max-extent", "40", "--tile-cells", "64", "--threads", "2"},
                "tiles.gpkg")
          .code,
      0);
  // Surveys are named by their first file: the same landmarks, other sources.
  ASSERT_EQ(buildings({"--las", b, a, "--max-extent", "40", "--tile-cells", "64"}, "files.gpkg").code, 0);
  EXPECT_EQ(rows("tiles.gpkg"), rows("town.gpkg"));
  EXPECT_EQ(of("building").size(), town.houses.size());
  EXPECT_EQ(of("building", "files.gpkg"), of("building"));
  EXPECT_EQ(of("wall_corner", "files.gpkg"), of("wall_corner"));
  EXPECT_EQ(of("pole", "files.gpkg"), of("pole"));
}

TEST_F(Buildings, FewReturnsGiveNoPolesButAWarningWithNumbers) {
  const Outcome made = buildings({"--las", write(file_of(made_town(203, 48), {.density = 4}, 1))});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err + made.out, HasSubstr("no poles are searched: 4 first returns per m2 are too few"));
  EXPECT_EQ(of("pole").size(), 0U);
  EXPECT_GE(of("building").size(), 1U);
  const Outcome without = buildings({"--las", folder_ / "town.laz", "--no-poles"}, "none.gpkg");
  EXPECT_THAT(without.err + without.out, testing::Not(HasSubstr("no poles")));
}

TEST_F(Buildings, TreesAreNotOnRoofs) {
  const MadeTown town = made_town(204, 72);
  const std::string file = write(file_of(town, {.density = 8}, 1));
  const auto on_roofs = [&](const std::string& map) {
    int count = 0;
    for (const json& tree : of("tree", map)) {
      const Eigen::Vector2d at(tree["x"].get<double>() - 500000, tree["y"].get<double>() - 5000000);
      const auto is_crown = [&](const MadeTree& t) { return (t.at - at).norm() < t.radius + 0.5; };
      count += std::ranges::any_of(town.houses, [&](const House& h) { return h.z(at) > 0; }) &&
               std::ranges::none_of(town.trees, is_crown);
    }
    return count;
  };
  ASSERT_EQ(waymark({"trees", "--las", file, "-o", folder_ / "keep.gpkg"}).code, 0);
  ASSERT_EQ(waymark({"trees", "--las", file, "--roofs", "remove", "-o", folder_ / "remove.gpkg"}).code, 0);
  ASSERT_EQ(buildings({"--las", file, "--trees"}).code, 0);
  std::printf(
      "treetops on roofs: %d kept, %d with --roofs remove, %d with buildings --trees; %zu of %zu trees\n",
      on_roofs("keep.gpkg"), on_roofs("remove.gpkg"), on_roofs("town.gpkg"), of("tree").size(),
      town.trees.size());
  EXPECT_GE(on_roofs("keep.gpkg"), 3);
  EXPECT_EQ(on_roofs("remove.gpkg"), 0);
  EXPECT_EQ(on_roofs("town.gpkg"), 0);
  EXPECT_EQ(of("tree").size(), of("tree", "remove.gpkg").size());
  EXPECT_GE(of("tree").size(), town.trees.size() / 2);
}

TEST_F(Buildings, OfPointsInFeetAreInMetres) {
  const MadeTown town = made_town(205, 48);
  const ScanRules scan{.density = 8};
  ASSERT_EQ(buildings({"--las", write(file_of(town, scan, 1))}).code, 0);
  LazFile feet = file_of(town, scan, 1, 1200.0 / 3937);
  feet.epsg = 2263;  // New York, US survey feet
  feet.origin = {980000, 190000, 0};
  const Outcome made = buildings({"--las", write(feet, "feet.laz")}, "feet.gpkg");
  ASSERT_EQ(made.code, 0) << made.err;
  const json metres = of("building"), other = of("building", "feet.gpkg");
  ASSERT_EQ(metres.size(), other.size());
  double sum = 0, sum_other = 0;
  for (const json& b : metres) sum += b["diameter"].get<double>() + b["height"].get<double>();
  for (const json& b : other) sum_other += b["diameter"].get<double>() + b["height"].get<double>();
  EXPECT_NEAR(sum_other / sum, 1, 0.01);
}

TEST_F(Buildings, WithoutClassifiedGroundAreFoundByItsShape) {
  const MadeTown town = made_town(206, 96);
  const Outcome made = buildings({"--las", write(file_of(town, {.density = 6, .classified = false}, 1))});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err + made.out, HasSubstr("no point is classified as ground"));
  EXPECT_GE(of("building").size(), town.houses.size() - 1);
  EXPECT_LE(of("building").size(), town.houses.size() + 1);
}

TEST_F(Buildings, OfRastersSkipCellsWithoutData) {
  const MadeTown town = made_town(207, 96);
  MadeDem chm{.columns = 192, .rows = 192, .geotransform = {500000, 0.5, 0, 5000096, 0, -0.5}};
  chm.height = [&](int column, int row) {
    const Eigen::Vector2d at(0.5 * column + 0.25, 96 - 0.5 * row - 0.25);
    double top = 0;
    for (const House& h : town.houses) top = std::max(top, h.z(at));
    return (column - 60) * (column - 60) + (row - 60) * (row - 60) < 40 ? std::nan("") : top;
  };
  const Outcome made = buildings({"--chm", make_dem(folder_ / "chm.tif", chm)});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_GE(of("building").size(), town.houses.size() - 2);
  EXPECT_THAT(made.err + made.out, HasSubstr("a raster has one height per cell"));
}

TEST_F(Buildings, BadInputIsRefused) {
  EXPECT_THAT(buildings({}).err, HasSubstr("no canopy is given"));
  EXPECT_THAT(buildings({"--dsm", "a.tif"}).err, HasSubstr("--dsm is given without --dtm"));
  LazFile degrees = file_of(made_town(208, 30), {.density = 2}, 1);
  degrees.epsg = 4326;
  EXPECT_THAT(buildings({"--las", write(degrees)}).err, HasSubstr("degrees"));
  LazFile noise = file_of(made_town(208, 30), {.density = 2}, 1);
  for (RawPoint& p : noise.chunks[0]) p.classification = 7;
  EXPECT_THAT(buildings({"--las", write(noise)}).err, HasSubstr("points are noise"));
  LazFile few{.format = 6, .chunks = {{}}};
  for (int i = 0; i < 20; ++i) few.chunks[0].push_back({.at = {10000 * i, 7000 * (i % 5), 100 * i}});
  EXPECT_THAT(buildings({"--las", write(few)}).err, HasSubstr("no point is classified as ground"));
  EXPECT_EQ(std::filesystem::exists(folder_ / "town.gpkg"), false);
}

TEST_F(Buildings, LocateARobotInTheStreet) {
  write_text(folder_ / "street.json", R"({"waymark_scenario": 1, "name": "Street", "seed": 911,
    "street": {"length": 80, "survey_pulses": 8}})");
  const std::string site = folder_ / "site";
  ASSERT_EQ(waymark({"simulate", folder_ / "street.json", "-o", site}).code, 0);
  const Outcome made = buildings({"--las", site + "/survey.las", "--crs", "local", "--overhang", "0.3"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Outcome driven = waymark({"localize", folder_ / "town.gpkg", site + "/log.jsonl", "-o",
                                  folder_ / "track.csv", "--method", "ekf", "--ids", "unknown"});
  ASSERT_EQ(driven.code, 0) << driven.err;
  const Outcome judged = waymark(
      {"evaluate", "track", folder_ / "track.csv", "--truth", site + "/truth/track.csv", "--format", "json"});
  ASSERT_EQ(judged.code, 0) << judged.err;
  const json result = json::parse(judged.out);
  EXPECT_LT(double(result["ate_rmse"]), 0.4) << judged.out;
  EXPECT_LT(double(result["heading_rmse_deg"]), 1) << judged.out;
  EXPECT_LT(double(result["lost"]), 0.2) << judged.out;
}

}  // namespace
}  // namespace waymark::test
