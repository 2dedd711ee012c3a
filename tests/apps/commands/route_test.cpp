// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <vector>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A desert of 200 m between start and goal, and rocks along a bow 50 m north of it.
class RouteCommand : public testing::Test {
 protected:
  RouteCommand() {
    std::string rocks = "x,y,radius,height\n";
    for (int x = -100; x <= 100; x += 8) {
      const double y = 50 - 0.005 * x * x;
      rocks += std::to_string(x) + "," + std::to_string(y) + ",0.5,0.6\n";
    }
    write_text(folder_ / "rocks.csv", rocks);
    const Outcome made =
        waymark({"import", folder_ / "rocks.csv", "-o", map_, "--type", "rock", "--map-crs", "local"});
    EXPECT_EQ(made.code, 0) << made.err;
  }
  Outcome route(const std::vector<std::string>& more, const std::string& out = "r.csv") {
    std::vector<std::string> words{
        "route",  map_,  "--from=-100,0", "--to", "100,0", "--sensor",   "horizontal_laser",
        "--view", "360", "--range",       "15",   "-o",    folder_ / out};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
  /// Largest value of a column of the stations.
  double largest(const std::string& column) {
    std::istringstream lines(text_of(folder_ / "r.csv"));
    std::string line, cell;
    std::getline(lines, line);
    std::istringstream names(line);
    int index = 0;
    while (std::getline(names, cell, ',') && cell != column) ++index;
    double value = -1e9;
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      for (int i = 0; i <= index; ++i) std::getline(cells, cell, ',');
      value = std::max(value, std::stod(cell));
    }
    return value;
  }

  TempFolder folder_;
  const std::string map_ = folder_ / "m.gpkg";
};

TEST_F(RouteCommand, StaysInTheAreaOfInterest) {
  const auto area = [this](const std::string& type, const std::string& coordinates) {
    write_text(folder_ / "area.geojson", R"({"type": "FeatureCollection", "features": [{"type": "Feature",
      "properties": {}, "geometry": {"type": ")" +
                                             type + R"(", "coordinates": )" + coordinates + "}}]}");
    return folder_ / "area.geojson";
  };
  ASSERT_EQ(route({"--weight", "1e-9"}).code, 0);
  EXPECT_LT(largest("y"), 5);
  // An arch: the way straight ahead is outside.
  const std::string arch =
      "[[[-110, -9], [-60, -9], [-60, 30], [60, 30], [60, -9], [110, -9], [110, 80], [-110, 80], [-110, "
      "-9]]]";
  const Outcome made = route({"--weight", "1e-9", "--aoi", area("Polygon", arch)});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NEAR(largest("y"), 31, 2);
  const std::string west = "[[[-110, -9], [-60, -9], [-60, 30], [-110, 30], [-110, -9]]]",
                    east = "[[[60, -9], [110, -9], [110, 30], [60, 30], [60, -9]]]";
  EXPECT_THAT(route({"--weight", "1", "--aoi", area("Polygon", west)}).err,
              AllOf(HasSubstr("--to 100,0 is outside the area of interest"), HasSubstr("area.geojson")));
  const Outcome parted =
      route({"--weight", "1", "--aoi", area("MultiPolygon", "[" + west + ", " + east + "]")});
  EXPECT_EQ(parted.code, 1) << parted.err;
  EXPECT_THAT(parted.err, AllOf(HasSubstr("there is no route from --from -100,0 to --to 100,0"),
                                HasSubstr("terrain outside the area of interest lies between")));
}

TEST_F(RouteCommand, LimitLeadsAlongTheLandmarks) {
  const Outcome shortest = route({"--weight", "1e-9"});
  ASSERT_EQ(shortest.code, 0) << shortest.err;
  EXPECT_NEAR(largest("distance"), 200, 1e-6);
  const double without = largest("sd");
  EXPECT_GT(without, 3);  // 200 m on odometry
  const Outcome limited = route({"--limit-sigma", "1.5"});
  ASSERT_EQ(limited.code, 0) << limited.err;
  EXPECT_LE(largest("sd"), 1.5);
  EXPECT_GT(largest("y"), 15);
  EXPECT_GT(largest("distance"), 205);
  EXPECT_THAT(limited.err, AllOf(HasSubstr("shortest route: 200.0 m"), HasSubstr("over 32 worlds"),
                                 HasSubstr("no route that keeps the limit is shorter than")));
}

TEST_F(RouteCommand, LandmarksAreKeptInSight) {
  const Outcome kept = route({"--keep-landmarks", "1"});
  ASSERT_EQ(kept.code, 0) << kept.err;
  EXPECT_THAT(kept.err, HasSubstr(" 0.0 m with fewer than 1 landmarks in sight"));
  EXPECT_GT(largest("y"), 30);
}

// 300 m of Taveuni across 180 degrees: one line would go round the Earth.
TEST_F(RouteCommand, LineIsDividedAtTheAntimeridian) {
  std::string rocks = "x,y,radius,height\n";
  for (int i = 0; i < 30; ++i)
    rocks +=
        (i < 15 ? "179.998" + std::to_string(500 + 100 * i) : "-179.999" + std::to_string(900 - 20 * i)) +
        ",-17.0001,0.5,0.6\n";
  write_text(folder_ / "taveuni.csv", rocks);
  const std::string map = folder_ / "taveuni.gpkg";
  const Outcome made =
      waymark({"import", folder_ / "taveuni.csv", "-o", map, "--type", "rock", "--map-crs", "EPSG:4326"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Outcome done = waymark({"route", map, "--from=179.9986,-17", "--to=-179.9986,-17", "--sensor",
                                "horizontal_laser", "--weight", "1", "-o", folder_ / "r.geojson"});
  ASSERT_EQ(done.code, 0) << done.err;
  const auto lines =
      nlohmann::json::parse(text_of(folder_ / "r.geojson"))["features"][0]["geometry"]["coordinates"];
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].back()[0], 180.0);
  EXPECT_EQ(lines[1].front()[0], -180.0);
  EXPECT_EQ(lines[0].back()[1], lines[1].front()[1]);
  for (const auto& at : lines[0]) EXPECT_GT(at[0], 179.99);
  for (const auto& at : lines[1]) EXPECT_LT(at[0], -179.99);
}

TEST_F(RouteCommand, LimitThatNoWorldAllowsNamesTheLeastLimit) {
  const Outcome none = route({"--limit-sigma", "0.02", "--start-sd", "0.01"});
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.err, AllOf(HasSubstr("no route keeps the sd of the position below 0.02 m"),
                              HasSubstr("can be kept, even if every landmark is seen"),
                              HasSubstr("the shortest route keeps")));
}

// The relaxed test knows the heading, so it does not exclude this limit.
TEST_F(RouteCommand, LimitThatCannotBeKeptNamesTheLeastFound) {
  const Outcome none = route({"--limit-sigma", "0.11"});
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.err, AllOf(HasSubstr("no route keeps the sd of the position below 0.11 m"),
                              HasSubstr("the least worst sd that was found is")));
}

TEST_F(RouteCommand, OutputsHoldRouteAndStations) {
  ASSERT_EQ(route({"--limit-sigma", "1.5", "--alternatives", "2"}, "r.geojson").code, 0);
  const auto collection = nlohmann::json::parse(text_of(folder_ / "r.geojson"));
  EXPECT_EQ(collection["features"][0]["geometry"]["type"], "LineString");
  EXPECT_EQ(collection["features"][0]["properties"]["layer"], "route");
  EXPECT_EQ(collection["features"].back()["properties"]["layer"], "route_station");
  ASSERT_EQ(route({"--limit-sigma", "1.5"}, "r.gpkg").code, 0);
  const Outcome valid = waymark({"validate", folder_ / "r.gpkg"});
  EXPECT_EQ(valid.code, 0) << valid.out << valid.err;
}

TEST_F(RouteCommand, HazardsAreAvoidedOrNamed) {
  MadeDem dem{.columns = 260, .rows = 140};
  dem.geotransform = {-130, 1, 0, 90, 0, -1};
  // A wall along x = 0 from y = -20 to the north, and a pit about the point -60, 0.
  dem.height = [](int column, int row) {
    if (column >= 66 && column <= 74 && row >= 86 && row <= 94) return 5.0;
    return column >= 128 && column <= 132 && row <= 110 ? 4.0 : 0.0;
  };
  ASSERT_EQ(waymark({"hazards", make_dem(folder_ / "d.tif", dem), "-o", folder_ / "h.tif"}).code, 0);
  const Outcome around = route({"--weight", "1e-9", "--hazards", folder_ / "h.tif"});
  ASSERT_EQ(around.code, 0) << around.err;
  EXPECT_GT(largest("distance"), 205);
  const auto refused = [&](const std::string& from) {
    const Outcome made =
        waymark({"route", map_, "--from=" + from, "--to", "100,0", "--sensor", "horizontal_laser", "--weight",
                 "1", "--hazards", folder_ / "h.tif", "-o", folder_ / "x.csv"});
    EXPECT_EQ(made.code, 1);
    return made.err;
  };
  EXPECT_THAT(refused("-2,0"), HasSubstr("--from -2,0 is in a hazard"));
  EXPECT_THAT(refused("-500,0"), HasSubstr("unknown terrain or outside the hazard map"));
}

TEST_F(RouteCommand, LeastSigmaIsBelowWhatOtherRoutesReach) {
  ASSERT_EQ(route({"--least-sigma"}).code, 0);
  const double least = largest("sd");
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"--weight", "1"}, {"--keep-landmarks", "2"}, {"--limit-sigma", "1.5"}}) {
    ASSERT_EQ(route(other).code, 0);
    EXPECT_LE(least, 1.02 * largest("sd")) << other[0];
  }
  const Outcome limited = route({"--limit-sigma", std::to_string(1.02 * least)});
  EXPECT_EQ(limited.code, 0) << limited.err;
  const Outcome below = route({"--limit-sigma", std::to_string(0.97 * least)});
  EXPECT_EQ(below.code, 1) << below.err;
}

TEST_F(RouteCommand, OdometryIsThatOfTheLog) {
  const std::string noise =
      R"("odometry_noise":{"along_per_metre":1e-5,"across_per_metre":1e-5,"yaw_per_metre":1e-6,"yaw_per_radian":0)";
  write_text(folder_ / "good.jsonl", R"({"kind":"header","version":1,)" + noise + "}}\n");
  write_text(folder_ / "drifts.jsonl",
             R"({"kind":"header","version":1,"start":{"x":0,"y":0,"yaw":0,"sd":0.02,"yaw_sd":0.001},)" +
                 noise + R"(,"scale_sd":0.03}})" + "\n");
  write_text(folder_ / "silent.jsonl", R"({"kind":"header","version":1})"
                                       "\n");
  ASSERT_EQ(route({"--weight", "1e-9"}).code, 0);
  const double unknown = largest("sd");
  ASSERT_EQ(route({"--weight", "1e-9", "--odometry", folder_ / "good.jsonl"}).code, 0);
  EXPECT_LT(largest("sd"), 0.5 * unknown);
  const Outcome drifts =
      waymark({"route", map_, "--from=-60,-60", "--to", "60,-60", "--sensor", "horizontal_laser", "--weight",
               "1e-9", "--odometry", folder_ / "drifts.jsonl", "-o", folder_ / "r.csv"});
  ASSERT_EQ(drifts.code, 0) << drifts.err;
  EXPECT_NEAR(largest("sd"), 0.03 * 120, 0.1) << "a scale of 3 % over 120 m without landmarks";
  // Among the landmarks the scale is learned, and a limit is kept with what is then known.
  const Outcome limited = route({"--limit-sigma", "1", "--odometry", folder_ / "drifts.jsonl"});
  ASSERT_EQ(limited.code, 0) << limited.err;
  EXPECT_LE(largest("sd"), 1);
  EXPECT_THAT(route({"--weight", "1", "--odometry", folder_ / "silent.jsonl"}).err,
              HasSubstr("the log states no odometry noise"));
}

TEST_F(RouteCommand, TerrainHidesLandmarks) {
  MadeDem dem{.columns = 260, .rows = 140};
  dem.geotransform = {-130, 1, 0, 90, 0, -1};
  dem.height = [](int, int row) { return row == 80 ? 3.0 : 0.0; };  // a wall along y = 9.5
  const std::string wall = make_dem(folder_ / "wall.tif", dem);
  const auto seen = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{
        "route",  map_,  "--from=-100,0", "--to", "-90,0", "--sensor",        "horizontal_laser",
        "--view", "360", "--range",       "25",   "-o",    folder_ / "r.csv", "--weight",
        "1e-9"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome made = waymark(words);
    EXPECT_EQ(made.code, 0) << made.err;
    return largest("landmarks");
  };
  EXPECT_GT(seen({}), 0);
  EXPECT_EQ(seen({"--dem", wall}), 2) << "rocks at y = 0 and 7.7";
  EXPECT_GT(seen({"--dem", wall, "--sensor-height", "20"}), 2);
}

/// In a south polar map of the Moon east is any direction of the grid.
TEST_F(RouteCommand, YawsAreOfTheGridOfTheMap) {
  std::string rocks = "x,y,radius,height\n";
  for (int x = -100; x <= 100; x += 20) rocks += std::to_string(30000 + x) + ",-52000,0.5,0.6\n";
  write_text(folder_ / "polar.csv", rocks);
  const std::string polar = folder_ / "polar.gpkg";
  ASSERT_EQ(
      waymark({"import", folder_ / "polar.csv", "-o", polar, "--type", "rock", "--map-crs", "IAU_2015:30135"})
          .code,
      0);
  const auto stations = [&](const std::string& from, const std::string& output) {
    const Outcome made = waymark({"route", polar, "--from", from, "--to", "30060,-52010", "--sensor",
                                  "horizontal_laser", "--view", "360", "--range", "30", "--weight", "1e-9",
                                  "--cell", "1", "-o", folder_ / output});
    EXPECT_EQ(made.code, 0) << made.err;
    std::istringstream lines(text_of(folder_ / output));
    std::string line, cell;
    std::getline(lines, line);
    EXPECT_THAT(line, testing::StartsWith("distance,x,y,yaw,"));
    std::vector<std::array<double, 4>> rows;
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      for (double& value : rows.emplace_back()) std::getline(cells, cell, ','), value = std::stod(cell);
    }
    return rows;
  };
  const auto rows = stations("29960,-51990", "polar_route.csv");
  ASSERT_GT(rows.size(), 20);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double driven = std::atan2(rows[i][2] - rows[i - 1][2], rows[i][1] - rows[i - 1][1]);
    EXPECT_NEAR(std::remainder(rows[i][3] - driven, 2 * std::numbers::pi), 0, 1e-3) << "station " << i;
  }
  // A start that looks backwards along the grid is within the half of a sector of what was asked.
  const auto turned = stations("29960,-51990,180", "polar_turn.csv");
  EXPECT_LT(std::abs(std::remainder(turned[0][3] - std::numbers::pi, 2 * std::numbers::pi)),
            std::numbers::pi / 8 + 1e-3);
}

TEST_F(RouteCommand, BeginsAndEndsWhereAsked) {
  const auto ends = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"route",   map_, "--sensor", "horizontal_laser", "--view",       "360",
                                   "--range", "15", "-o",       folder_ / "r.csv",  "--least-sigma"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome done = waymark(words);
    EXPECT_EQ(done.code, 0) << done.err;
    std::istringstream lines(text_of(folder_ / "r.csv"));
    std::vector<std::array<double, 3>> stations;  // distance, x, y
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      std::array<double, 3> station{};
      for (double& value : station) {
        std::string cell;
        std::getline(cells, cell, ',');
        value = std::stod(cell);
      }
      stations.push_back(station);
    }
    double length = 0;
    for (std::size_t k = 1; k < stations.size(); ++k)
      length += std::hypot(stations[k][1] - stations[k - 1][1], stations[k][2] - stations[k - 1][2]);
    EXPECT_NEAR(stations.back()[0], length, 0.01);
    return std::pair(stations.front(), stations.back());
  };
  for (const char* cell : {"2", "3.7"}) {
    const auto [first, last] = ends({"--from=-20.63,3.28", "--to", "31.41,5.92", "--cell", cell});
    EXPECT_NEAR(first[1], -20.63, 1e-4);
    EXPECT_NEAR(first[2], 3.28, 1e-4);
    EXPECT_NEAR(last[1], 31.41, 1e-4);
    EXPECT_NEAR(last[2], 5.92, 1e-4);
  }
  const Outcome coarse = route({"--least-sigma", "--cell", "500"});
  EXPECT_EQ(coarse.code, 2);
  EXPECT_THAT(
      coarse.err,
      HasSubstr("--from -100,0 and --to 100,0 lie in one cell of 500 m, 200 m apart\n  --cell 1e+02"));
}

TEST_F(RouteCommand, HazardsAreAHazardMap) {
  const std::string dem =
      make_dem(folder_ / "dem.tif",
               {.columns = 300, .rows = 300, .crs = "", .geotransform = {-150, 1, 0, 150, 0, -1}});
  EXPECT_THAT(route({"--least-sigma", "--hazards", dem}).err,
              AllOf(HasSubstr("this is no hazard map"), HasSubstr("`waymark hazards` makes one")));
  ASSERT_EQ(waymark({"hazards", map_, "--dem", dem, "-o", folder_ / "hazard.tif"}).code, 0);
  // Farther than a search reaches: what is wrong is the position.
  EXPECT_THAT(route({"--least-sigma", "--hazards", folder_ / "hazard.tif", "--via", "9000,0"}).err,
              HasSubstr("--via 9000,0 is on unknown terrain or outside the hazard map"));
}

TEST_F(RouteCommand, BadRequestsAreRefused) {
  EXPECT_THAT(route({"--weight", "-1"}).err, HasSubstr("--weight -1 is negative"));
  EXPECT_THAT(route({"--weight", "1", "--start-sd", "-1"}).err, HasSubstr("--start-sd -1 is negative"));
  EXPECT_THAT(route({"--weight", "1", "--speed", "0"}).err, HasSubstr("--speed 0 is not above 0 m/s"));
  EXPECT_THAT(route({}).err, HasSubstr("the route has no objective"));
  EXPECT_THAT(route({"--limit-sigma", "0"}).err, HasSubstr("each above 0"));
  EXPECT_THAT(route({"--weight", "1", "--worlds", "1000000000"}).err,
              HasSubstr("--worlds = 1000000000 is outside [1, 100000]"));
  EXPECT_THAT(waymark({"route", map_, "--from=0,0", "--to", "9,0", "--sensor", "horizontal_laser", "--view",
                       "400", "--weight", "1", "-o", folder_ / "r.csv"})
                  .err,
              HasSubstr("--view = 400 is outside [0, 360] deg"));
  EXPECT_THAT(route({"--weight", "1", "--by-quality"}).err, HasSubstr("pass --keep-landmarks N"));
  EXPECT_THAT(route({"--weight", "1", "--vehicle", "rovver"}).err, HasSubstr("rover"));
  EXPECT_THAT(route({"--weight", "1"}, "m.gpkg").err, HasSubstr("the output would replace the input"));
  EXPECT_THAT(route({"--weight", "1", "--limit-sigma", "1"}).err, HasSubstr("more than one objective"));
  EXPECT_THAT(route({"--limit-sigma", "0.01"}).err, HasSubstr("the sd at the start, 0.1 m, exceeds"));
  EXPECT_THAT(route({"--weight", "1"}, "r.txt").err, HasSubstr("does not end in"));
  EXPECT_THAT(route({"--weight", "1", "--via", "7"}).err, HasSubstr("--via 7 is no position"));
  EXPECT_THAT(route({"--weight", "1", "--via", "700000,0"}).err,
              HasSubstr("700 km from the middle of the map"));
  EXPECT_THAT(route({"--weight", "1", "--via", "7,1,90"}).err,
              HasSubstr("--via 7,1,90 has three numbers: only --from has a yaw"));
  EXPECT_THAT(waymark({"route", map_, "--from=0,0", "--to", "9,0", "--sensor", "descent_camera", "--weight",
                       "1", "-o", folder_ / "r.csv"})
                  .err,
              HasSubstr("has no range"));
}

}  // namespace
}  // namespace waymark::test
