// SPDX-License-Identifier: Apache-2.0
// --aoi of the commands that make maps: what lies inside is as in the map of all, what lies outside is
// absent.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>

#include "made_dem.hpp"
#include "made_flight.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class AreaOfInterest : public testing::Test {
 protected:
  /// Writes the rectangle from -1e6 to `east` as an area.
  std::string west_of(double east, const std::string& crs) {
    const std::string file = folder_ / "area.geojson";
    const std::string named =
        crs.empty() ? "" : R"("crs": {"type": "name", "properties": {"name": ")" + crs + R"("}},)";
    write_text(file, fmt::format(R"({{"type": "FeatureCollection", {}
 "features": [{{"type": "Feature", "properties": {{}}, "geometry": {{"type": "Polygon", "coordinates":
 [[[-1000000, -9000000], [{}, -9000000], [{}, 9000000], [-1000000, 9000000], [-1000000, -9000000]]]}}}}]}})",
                                 named, east, east));
    return file;
  }

  /// Returns the landmarks of a map by uid: rows follow a curve over the extent of the map.
  std::map<std::string, json> landmarks(const std::string& map) {
    std::map<std::string, json> by_uid;
    for (const json& landmark : json::parse(waymark({"query", folder_ / map, "--format", "json"}).out))
      by_uid[landmark["uid"]] = landmark;
    return by_uid;
  }

  /// Makes the map of all and that of the area; both must agree west of `east`, and the second be empty
  /// beyond.
  void expect_same_inside(std::vector<std::string> command, double east, const std::string& crs) {
    command.insert(command.end(), {"-o", folder_ / "all.gpkg"});
    const Outcome all = waymark(command);
    ASSERT_EQ(all.code, 0) << all.err;
    command.back() = folder_ / "area.gpkg";
    command.insert(command.end(), {"--aoi", west_of(east, crs)});
    const Outcome part = waymark(command);
    ASSERT_EQ(part.code, 0) << part.err;
    EXPECT_THAT(part.err, HasSubstr("outside the area of interest"));
    EXPECT_EQ(waymark({"validate", folder_ / "area.gpkg"}).out, "");

    std::map<std::string, json> inside = landmarks("all.gpkg");
    EXPECT_GT(std::erase_if(inside,
                            [&](const auto& one) { return one.second["x"].template get<double>() >= east; }),
              0U);
    EXPECT_GT(inside.size(), 0U);
    EXPECT_TRUE(landmarks("area.gpkg") == inside);
  }

  std::string rows_of(const std::string& map, const std::string& layer) {
    return bash("ogrinfo -ro -q '" + (folder_ / map) + "' " + layer + " | grep -c OGRFeature").out;
  }

  TempFolder folder_;
};

/// Cones every 8 m, 10 to 19 m high, cells of 0.5 m.
MadeDem cones_at_origin() {
  MadeDem chm{.columns = 300, .rows = 200, .geotransform = {500000, 0.5, 0, 5200000, 0, -0.5}};
  chm.height = [](int column, int row) {
    const double x = 0.5 * column, y = 0.5 * row, i = std::floor(x / 8), j = std::floor(y / 8);
    const double top = 10 + std::fmod(3 * i + 5 * j, 10);
    return std::max(0.0, top - 4 * std::hypot(x - 8 * i - 4, y - 8 * j - 4));
  };
  return chm;
}

TEST_F(AreaOfInterest, OfTreesAndTheirCrowns) {
  const std::string chm = make_dem(folder_ / "chm.tif", cones_at_origin());
  expect_same_inside({"trees", "--chm", chm}, 500061, "urn:ogc:def:crs:EPSG::32632");
  EXPECT_EQ(rows_of("area.gpkg", "crown"), rows_of("area.gpkg", "tree"));
  EXPECT_NE(rows_of("area.gpkg", "crown"), rows_of("all.gpkg", "crown"));
}

TEST_F(AreaOfInterest, OfTreesOfSeveralFlights) {
  const std::string chm = make_dem(folder_ / "chm.tif", cones_at_origin()),
                    same = make_dem(folder_ / "b.tif", cones_at_origin());
  expect_same_inside({"trees", "--flights", "--chm", chm, same}, 500061, "urn:ogc:def:crs:EPSG::32632");
  EXPECT_EQ(rows_of("area.gpkg", "crown"), rows_of("area.gpkg", "tree"));
}

TEST_F(AreaOfInterest, OfAMapThatIsMade) {
  const std::string chm = make_dem(folder_ / "chm.tif", cones_at_origin());
  ASSERT_EQ(waymark({"trees", "--chm", chm, "-o", folder_ / "all.gpkg"}).code, 0);
  const std::string all = folder_ / "all.gpkg";
  const std::string area = west_of(500061, "urn:ogc:def:crs:EPSG::32632");
  const auto is_inside = [](const auto& one) { return one.second["x"].template get<double>() < 500061; };
  std::map<std::string, json> inside = landmarks("all.gpkg");
  EXPECT_GT(std::erase_if(inside, [&](const auto& one) { return !is_inside(one); }), 0U);
  ASSERT_GT(inside.size(), 9U);

  std::map<std::string, json> asked;
  for (const json& one : json::parse(waymark({"query", all, "--aoi", area, "--format", "json"}).out))
    asked[one["uid"]] = one;
  EXPECT_TRUE(asked == inside);
  const auto count = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"query", all, "--aoi", area, "--format", "json"});
    return json::parse(waymark(more).out).size();
  };
  EXPECT_EQ(count({"--limit", "5"}), 5U);
  EXPECT_EQ(count({"--nearest", "500149", "5199950", "7"}), 7U);

  const Outcome cut = waymark({"export", all, folder_ / "area.gpkg", "--aoi", area});
  ASSERT_EQ(cut.code, 0) << cut.err;
  EXPECT_THAT(cut.err, HasSubstr("layers of the whole map are left out: survey"));
  EXPECT_EQ(waymark({"validate", folder_ / "area.gpkg"}).out, "");
  EXPECT_TRUE(landmarks("area.gpkg") == inside);
  EXPECT_EQ(rows_of("area.gpkg", "crown"), rows_of("area.gpkg", "tree"));
  const Outcome robot = waymark({"export", all, folder_ / "t.yaml", "-of", "beluga", "--aoi", area});
  EXPECT_EQ(robot.code, 2);
  EXPECT_THAT(robot.err, HasSubstr("export the area to a .gpkg first"));
  const Outcome label = waymark({"export", all, folder_ / "t.yaml", "-of", "beluga", "--label", "A=B"});
  EXPECT_THAT(label.err, HasSubstr("--label and --area do not apply"));
}

TEST_F(AreaOfInterest, OfRocksAndCratersInImages) {
  const auto site = simulate_flight(folder_.path(), {});
  expect_same_inside({"images", site / "images", "--cameras", site / "cameras.json", "--dem",
                      site / "dem.tif", "--crs", "local"},
                     0, "");
}

TEST_F(AreaOfInterest, OfCratersInADem) {
  MadeDem dem{.columns = 400, .rows = 200, .geotransform = {0, 10, 0, 2000, 0, -10}};
  dem.height = [](int column, int row) {
    double height = 0;
    for (const auto [x, y, radius] : {std::array{100., 100., 25.}, std::array{300., 100., 30.}}) {
      const double r = std::hypot(column - x, row - y) / radius;
      height += 10 * radius * (r < 1 ? 0.45 * r * r - 0.37 : 0.08 / (r * r * r));
    }
    return height;
  };
  expect_same_inside({"craters", "--dem", make_dem(folder_ / "dem.tif", dem)}, 2000,
                     "urn:ogc:def:crs:EPSG::32632");
}

TEST_F(AreaOfInterest, OffTheDataIsRefusedWithBothExtents) {
  const std::string dem = make_dem(folder_ / "dem.tif", twin_peaks()),
                    chm = make_dem(folder_ / "chm.tif", cones_at_origin()),
                    area = west_of(-999000, "urn:ogc:def:crs:EPSG::32632");
  for (const std::vector<std::string>& command : {std::vector<std::string>{"peaks", dem},
                                                  {"craters", "--dem", dem},
                                                  {"hazards", dem},
                                                  {"trees", "--chm", chm},
                                                  {"trees", "--flights", "--chm", chm, chm},
                                                  {"buildings", "--dsm", chm, "--dtm", chm}}) {
    std::vector<std::string> words = command;
    words.insert(words.end(), {"-o", folder_ / "none.gpkg", "--aoi", area});
    if (command[0] == "hazards") words[3] = folder_ / "none.tif";
    const Outcome said = waymark(words);
    EXPECT_EQ(said.code, 1) << command[0];
    EXPECT_THAT(said.err, AllOf(HasSubstr("the area of interest lies off the "), HasSubstr("covers x 50"),
                                HasSubstr("the area x -1000000 to -999000")))
        << command[0];
  }
}

TEST_F(AreaOfInterest, OffTheDataInDegreesCountsTurns) {
  MadeDem degrees = twin_peaks();
  degrees.crs = "EPSG:4326";
  degrees.geotransform = {359, 0.001, 0, 47, 0, -0.001};
  const std::string dem = make_dem(folder_ / "dem.tif", degrees);
  const auto area_at = [&](double lon) {
    write_text(folder_ / "area.geojson",
               fmt::format(R"({{"type": "Polygon", "coordinates": [[[{0}, 0], [{1}, 0], [{1}, 60], [{0}, 60],
 [{0}, 0]]]}})",
                           lon, lon + 2));
    return folder_ / "area.geojson";
  };
  EXPECT_EQ(waymark({"peaks", dem, "-o", folder_ / "p.gpkg", "--aoi", area_at(-1.5)}).code, 0);
  EXPECT_THAT(waymark({"peaks", dem, "-o", folder_ / "q.gpkg", "--aoi", area_at(10)}).err,
              HasSubstr("lies off the DEM"));
}

TEST_F(AreaOfInterest, NeedsGroundInImages) {
  const Outcome said = waymark({"images", "a.png", "--aoi", west_of(0, ""), "--check"});
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, HasSubstr("--aoi is an option of load_dem, which this job does not have"));
}

}  // namespace
}  // namespace waymark::test
