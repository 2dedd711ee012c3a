// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A map of the twin peaks: 900 m at (501500, 5198500) and 700 m at (505500, 5198500), EPSG:32632.
class Query : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    const std::string dem = make_dem(*folder_ / "twins.tif", twin_peaks());
    ASSERT_EQ(waymark({"peaks", dem, "-o", *folder_ / "twins.gpkg"}).code, 0);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static Outcome query(std::vector<std::string> words) {
    words.insert(words.begin(), {"query", *folder_ / "twins.gpkg"});
    return waymark(words);
  }
  /// Elevations of what is found, in the order printed.
  static std::vector<double> elevations(std::vector<std::string> words) {
    words.insert(words.end(), {"--format", "json"});
    const Outcome said = query(words);
    EXPECT_EQ(said.code, 0) << said.err;
    std::vector<double> all;
    for (const json& top : json::parse(said.out)) all.push_back(top["elevation"]);
    return all;
  }

 private:
  inline static std::unique_ptr<TempFolder> folder_;
};

TEST_F(Query, ByBox) {
  EXPECT_THAT(elevations({"--bbox", "505000", "5198000", "506000", "5199000"}), ElementsAre(700));
  EXPECT_THAT(query({"--bbox", "5", "9", "1", "2"}).err, HasSubstr("X0 <= X1, Y0 <= Y1"));
}

TEST_F(Query, ByBoxInDegrees) {
  // 9 degrees east is x = 500000: the peaks lie 1.5 and 5.5 km east of it, 0.0198 and 0.0724 degrees at 46.9
  // N.
  const std::vector<std::string> box{"--crs", "EPSG:4326", "--bbox", "9", "46", "9.05", "47"};
  EXPECT_THAT(elevations(box), ElementsAre(900));
  std::vector<std::string> nearest_in_box{"--nearest", "9.1", "46.94", "1"};  // the other peak is nearer
  nearest_in_box.insert(nearest_in_box.end(), box.begin(), box.end());
  EXPECT_THAT(elevations(nearest_in_box), ElementsAre(900));
}

TEST_F(Query, NearestFirst) {
  EXPECT_THAT(elevations({"--near", "505000", "5198500", "1000"}), ElementsAre(700));
  EXPECT_THAT(elevations({"--near", "505000", "5198500", "9000"}), ElementsAre(700, 900));
  EXPECT_THAT(elevations({"--nearest", "505000", "5198500", "1"}), ElementsAre(700));
  EXPECT_THAT(query({"--near", "1", "2", "-5"}).err, HasSubstr("RADIUS of --near must be 0 or more"));
}

TEST_F(Query, ByFeature) {
  EXPECT_THAT(elevations({"--min", "prominence=500"}), ElementsAre(900));
  EXPECT_THAT(elevations({"--max", "elevation=800"}), ElementsAre(700));
  EXPECT_THAT(elevations({"--min", "elevation=600", "--max", "elevation=650"}), IsEmpty());
  EXPECT_EQ(query({"--min", "prominense=1"}).code, 2);
  EXPECT_THAT(query({"--min", "prominence"}).err, HasSubstr("--min takes FEATURE=VALUE, is 'prominence'"));
}

TEST_F(Query, ByConfidenceQualityAndCounts) {
  // 900 m has certain prominence (confidence 1), 700 m is certain of all of its 300 m.
  EXPECT_THAT(elevations({"--min", "seen=1", "--largest", "confidence"}).size(), 2);
  EXPECT_THAT(elevations({"--min", "seen=2"}), IsEmpty());
  EXPECT_THAT(elevations({"--min", "quality=0"}), IsEmpty());  // one DEM is no assessment
  EXPECT_THAT(elevations({"--min-confidence", "0.01"}).size(), 2);
  EXPECT_THAT(elevations({"--min", "confidence=1.01"}), IsEmpty());
  EXPECT_THAT(elevations({"--min", "prominence_low=500"}), ElementsAre(900));
  EXPECT_THAT(query({"--min-confidence", "50"}).err, HasSubstr("--min-confidence = 50 is outside [0, 1]"));
  EXPECT_THAT(query({"--min", "confidense=1"}).err, HasSubstr("did you mean 'confidence'?"));
}

TEST_F(Query, ABoundOfAnUnknownNumberIsSaid) {
  const Outcome empty = query({"--min", "quality=0.9"});
  EXPECT_EQ(empty.code, 0);
  EXPECT_THAT(empty.err, HasSubstr("no landmark has a known 'quality'"));
}

TEST_F(Query, AnEmptyAnswerSaysWhy) {
  const auto reason = [](const std::vector<std::string>& words) {
    const Outcome empty = query(words);
    EXPECT_EQ(empty.code, 0) << empty.err;
    return empty.err;
  };
  EXPECT_THAT(reason({"--min", "elevation=5000"}),
              HasSubstr("no landmark has 'elevation' of at least 5000: its values are 700 to 900"));
  EXPECT_THAT(reason({"--max", "elevation=5"}), HasSubstr("of at most 5: its values are 700 to 900"));
  EXPECT_THAT(reason({"--min", "elevation=800", "--max", "prominence=400"}),
              HasSubstr("no landmark meets all conditions, though some meet each of them"));
  EXPECT_THAT(reason({"--bbox", "0", "0", "9", "9"}),
              HasSubstr("cover x 501500 to 505500, y 5198500 to 5198500 in EPSG:32632"));
  EXPECT_THAT(reason({"--near", "0", "0", "5"}), HasSubstr("no landmark lies there"));
  EXPECT_THAT(reason({"--crs", "EPSG:4326", "--bbox", "1", "1", "2", "2"}),
              HasSubstr("no landmark lies there"));
  EXPECT_THAT(reason({"--limit", "0"}), IsEmpty());
  EXPECT_THAT(reason({"--min", "elevation=800"}), IsEmpty());
}

TEST_F(Query, BoundsThatExcludeEachOtherAreRefused) {
  const Outcome said = query({"--min", "elevation=900", "--max", "elevation=800"});
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, HasSubstr("--min elevation=900 is above --max elevation=800"));
  EXPECT_THAT(query({"--nearest", "0", "0", "2.5"}).err,
              HasSubstr("COUNT of --nearest must be a whole number, is 2.5"));
}

TEST_F(Query, ATypeThatTheMapLacksIsNotCalledUnknown) {
  EXPECT_THAT(query({"--type", "crater"}).err, AllOf(HasSubstr("this map has no landmarks of type 'crater'"),
                                                     HasSubstr("it has: mountain_top")));
}

TEST_F(Query, ByExpectedVisibility) {
  EXPECT_THAT(elevations({"--min", "visibility=0", "--largest", "visibility"}), ElementsAre(900, 700));
  EXPECT_THAT(elevations({"--min", "visibility=1.01"}), IsEmpty());
}

TEST_F(Query, WhatIsNotAssessedHasNoQualityAndTheTableShowsConfidence) {
  const Outcome table = query({});
  EXPECT_THAT(table.out, AllOf(HasSubstr("quality"), HasSubstr("confidence"), HasSubstr("  -  ")));
  for (const json& top : json::parse(query({"--format", "json"}).out)) {
    EXPECT_TRUE(top["quality"].is_null());
    EXPECT_TRUE(top["var_z"].is_null());  // the DEM states no accuracy
  }
}

TEST_F(Query, MetresAreNotTakenForDegrees) {
  const TempFolder folder;
  MadeDem degrees = twin_peaks();
  degrees.crs = "EPSG:4326";
  degrees.geotransform = {8, 0.01, 0, 47, 0, -0.01};
  const std::string map = folder / "degrees.gpkg";
  ASSERT_EQ(waymark({"peaks", make_dem(folder / "d.tif", degrees), "-o", map}).code, 0);
  const Outcome near = waymark({"query", map, "--near", "500", "900", "10"});
  EXPECT_EQ(near.code, 2);
  EXPECT_THAT(near.err, AllOf(HasSubstr("--near has the position 500 900"), HasSubstr("degrees (EPSG:4326)"),
                              HasSubstr("--crs")));
  EXPECT_THAT(waymark({"query", map, "--bbox", "0", "0", "5000", "5000"}).err,
              HasSubstr("--bbox has the position"));
  EXPECT_EQ(waymark({"query", map, "--near", "368", "47", "9000"}).code, 0);  // 8 degrees east, once around
}

TEST_F(Query, LargestFirstAndLimit) {
  EXPECT_THAT(elevations({"--largest", "prominence"}), ElementsAre(900, 700));
  EXPECT_THAT(elevations({"--largest", "prominence", "--limit", "1"}), ElementsAre(900));
}

TEST_F(Query, UnknownTypeAndSensorNameTheNearest) {
  EXPECT_THAT(query({"--type", "mountain_tip"}).err, HasSubstr("did you mean 'mountain_top'?"));
  EXPECT_THAT(query({"--sensor", "stereo_camara"}).err, HasSubstr("did you mean 'stereo_camera'?"));
}

TEST_F(Query, SensorWeighsTheQuality) {
  EXPECT_EQ(query({"--sensor", "bearing_camera", "--min-quality", "0.1"}).code, 0);
}

TEST(QueryTable, SmallLengthsHaveTheirDigits) {
  const TempFolder folder;
  write_text(folder / "trees.csv", "uid,x,y,height,diameter\na,1,2,23.456,0.3468\nb,5,2,9.8,0.05\n");
  ASSERT_EQ(waymark({"import", folder / "trees.csv", "-o", folder / "t.gpkg", "--type", "tree", "--map-crs",
                     "local"})
                .code,
            0);
  const std::string table = waymark({"query", folder / "t.gpkg"}).out;
  EXPECT_THAT(table,
              AllOf(HasSubstr(" 23.46 "), HasSubstr(" 0.347 "), HasSubstr(" 9.80 "), HasSubstr(" 0.050 ")));
}

TEST_F(Query, TableIsAligned) {
  std::istringstream lines(query({"--largest", "elevation"}).out);
  std::string header, first, second;
  std::getline(lines, header);
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_THAT(header, AllOf(StartsWith("type"), HasSubstr("prominence [m]")));
  EXPECT_EQ(header.find("elevation [m]") + 13, first.find("900.0") + 5);
  EXPECT_EQ(first.size(), second.size());
}

TEST_F(Query, CsvHasEveryColumnOfTheMap) {
  EXPECT_THAT(query({"--format", "csv"}).out,
              StartsWith("type,uid,x,y,z,elevation,elevation_sd,elevation_q,prominence,"));
}

TEST_F(Query, GeoJsonIsLongitudeAndLatitude) {
  const json found = json::parse(query({"--min", "elevation=800", "--format", "geojson"}).out);
  const json& top = found["features"].at(0);
  EXPECT_NEAR(top["geometry"]["coordinates"][0].get<double>(), 9.0197, 1e-4);  // gdaltransform says so
  EXPECT_NEAR(top["geometry"]["coordinates"][1].get<double>(), 46.9400, 1e-4);
  EXPECT_EQ(top["geometry"]["coordinates"][2], 900);
  EXPECT_EQ(top["properties"]["elevation"], 900);
  EXPECT_EQ(top["id"], top["properties"]["uid"]);
}

TEST_F(Query, GeoJsonIsOfEarthOnly) {
  const TempFolder folder;
  MadeDem mars = twin_peaks();
  mars.crs = "IAU_2015:49900";
  mars.geotransform = {137, 0.01, 0, -4, 0, -0.01};
  const std::string map = folder / "mars.gpkg";
  ASSERT_EQ(waymark({"peaks", make_dem(folder / "mars.tif", mars), "-o", map, "--base", "lowest"}).code, 0);
  const Outcome said = waymark({"query", map, "--format", "geojson"});
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, HasSubstr("GeoJSON holds positions on Earth only; this map is on Mars"));
  EXPECT_THAT(waymark({"query", map, "--crs", "EPSG:4326"}).err, HasSubstr("Mars"));
  EXPECT_THAT(waymark({"query", map}).out, HasSubstr("137.015000  -4.015000"));
}

TEST_F(Query, AMapThatIsNotThere) {
  const Outcome said = waymark({"query", "/no/such/map.gpkg"});
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, AllOf(StartsWith("error: "), HasSubstr("/no/such/map.gpkg")));
}

}  // namespace
}  // namespace waymark::test
