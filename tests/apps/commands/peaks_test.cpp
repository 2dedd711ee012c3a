// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

/// Returns the rows of a query, their columns joined by blanks.
std::vector<std::string> sqlite_rows(const std::string& map, const std::string& sql) {
  sqlite3* file = nullptr;
  std::vector<std::string> rows;
  EXPECT_EQ(sqlite3_open(map.c_str(), &file), SQLITE_OK);
  const auto add = [](void* to, int columns, char** values, char**) {
    std::string row;
    for (int i = 0; i < columns; ++i) row += (i ? " " : "") + std::string(values[i] ? values[i] : "NULL");
    static_cast<std::vector<std::string>*>(to)->push_back(row);
    return 0;
  };
  EXPECT_EQ(sqlite3_exec(file, sql.c_str(), add, &rows, nullptr), SQLITE_OK) << sqlite3_errmsg(file);
  sqlite3_close(file);
  return rows;
}

class Peaks : public testing::Test {
 protected:
  /// Runs `waymark peaks` and returns the whole table of the map as CSV.
  std::string table(const std::vector<std::string>& more, const std::string& map = "map.gpkg") {
    std::vector<std::string> words{"peaks", "-o", folder_ / map};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome made = waymark(words);
    EXPECT_EQ(made.code, 0) << made.err;
    last_summary_ = made.err;
    return csv(map);
  }
  std::string csv(const std::string& map) { return waymark({"query", folder_ / map, "--format", "csv"}).out; }
  std::string twins() { return make_dem(folder_ / "twins.tif", twin_peaks()); }
  std::string rolling() { return make_dem(folder_ / "hills.tif", hills(300, 200)); }

  TempFolder folder_;
  std::string last_summary_;
};

TEST_F(Peaks, TwinPeaksEndToEnd) {
  table({twins(), "--distance", "planar"});
  const Outcome said =
      waymark({"query", folder_ / "map.gpkg", "--largest", "prominence", "--format", "json"});
  const json tops = json::parse(said.out);
  ASSERT_EQ(tops.size(), 2);
  EXPECT_EQ(tops[0]["elevation"], 900);
  EXPECT_EQ(tops[0]["prominence"], 900);  // from the sea
  EXPECT_EQ(tops[0]["isolation"], nullptr);
  EXPECT_EQ(tops[0]["x"], 501500);  // centre of the second cell
  EXPECT_EQ(tops[0]["y"], 5198500);
  EXPECT_EQ(tops[1]["elevation"], 700);
  EXPECT_EQ(tops[1]["prominence"], 300);
  EXPECT_EQ(tops[1]["isolation"], 4000);
  EXPECT_EQ(tops[1]["saddle_elevation"], 400);
  EXPECT_EQ(tops[1]["saddle_x"], 503500);
  EXPECT_EQ(tops[1]["parent_uid"], tops[0]["uid"]);
}

TEST_F(Peaks, SaddlesAndParentLinesAreLayersThatDoNotDependOnTiles) {
  table({rolling(), "--min-prominence", "1", "--tile-cells", "64"});
  const std::string map = folder_ / "map.gpkg";
  const std::string saddles = "SELECT uid, elevation, hex(geom) FROM saddle ORDER BY id";
  const std::string parents = "SELECT uid, parent_uid, hex(geom) FROM parent_line ORDER BY id";
  const auto known = sqlite_rows(
      map, "SELECT uid, saddle_elevation FROM mountain_top WHERE saddle_x IS NOT NULL ORDER BY id");
  ASSERT_GT(known.size(), 20);
  EXPECT_EQ(sqlite_rows(map, "SELECT uid, elevation FROM saddle ORDER BY id"), known);
  const auto lines = sqlite_rows(
      map,
      "SELECT a.uid, b.uid FROM mountain_top a JOIN mountain_top b ON b.uid = a.parent_uid ORDER BY a.id");
  ASSERT_GT(lines.size(), 20);
  EXPECT_EQ(sqlite_rows(map, "SELECT uid, parent_uid FROM parent_line ORDER BY id"), lines);
  // Both ends of a line are where the two summits are: a header with an envelope of 40 bytes, 9 of the
  // line's.
  const std::string ends =
      "SELECT count(*) FROM parent_line l JOIN mountain_top a ON a.uid = l.uid JOIN mountain_top b ON b.uid "
      "= "
      "l.parent_uid WHERE instr(hex(l.geom), substr(hex(a.geom), -48, 32)) > 0 AND "
      "instr(hex(l.geom), substr(hex(b.geom), -48, 32)) > 0";
  EXPECT_EQ(sqlite_rows(map, ends), (std::vector<std::string>{std::to_string(lines.size())}));
  table({rolling(), "--min-prominence", "1", "--tile-cells", "1000"}, "whole.gpkg");
  EXPECT_EQ(sqlite_rows(map, saddles), sqlite_rows(folder_ / "whole.gpkg", saddles));
  EXPECT_EQ(sqlite_rows(map, parents), sqlite_rows(folder_ / "whole.gpkg", parents));
  EXPECT_EQ(waymark({"validate", map}).code, 0);
}

TEST_F(Peaks, SummitsWithoutAKeySaddleMakeNoLayer) {
  table({twins(), "--min-prominence", "400"});
  const auto layers =
      sqlite_rows(folder_ / "map.gpkg",
                  "SELECT table_name FROM gpkg_contents WHERE table_name IN ('saddle', 'parent_line')");
  EXPECT_TRUE(layers.empty());
}

TEST_F(Peaks, SummaryTellsStagesCountsSpeedAndTheMap) {
  table({twins()});
  EXPECT_THAT(last_summary_, AllOf(HasSubstr("find_mountain_tops"), HasSubstr("rejected"),
                                   HasSubstr("cells/s"), HasSubstr("map.gpkg: 2 mountain_top")));
}

TEST_F(Peaks, SummitsAreNamedAfterTheNearestPoints) {
  write_text(folder_ / "names.csv",
             "name,x,y\nGro\xC3\x9F"
             "er Kopf,501600,5198500\nFar away,509000,5198500\n"
             "Farther,505300,5198500\nKleiner Kopf,505450,5198450\n,501500,5198500\n");
  table({twins(), "--names", folder_ / "names.csv"});
  const json tops = json::parse(waymark({"query", folder_ / "map.gpkg", "--format", "json"}).out);
  ASSERT_EQ(tops.size(), 2);
  for (const json& top : tops)
    EXPECT_EQ(top["name"], top["elevation"] == 900 ? "Gro\xC3\x9F"
                                                     "er Kopf"
                                                   : "Kleiner Kopf");
}

TEST_F(Peaks, WithoutAGazetteerSummitsHaveNoNames) {
  table({twins()});
  const json tops = json::parse(waymark({"query", folder_ / "map.gpkg", "--format", "json"}).out);
  for (const json& top : tops) EXPECT_EQ(top["name"], nullptr);
}

TEST_F(Peaks, GazetteerWithoutNamesIsRefused) {
  write_text(folder_ / "names.csv", "summit,x,y\nA,1,2\n");
  const Outcome said =
      waymark({"peaks", twins(), "--names", folder_ / "names.csv", "-o", folder_ / "m.gpkg"});
  EXPECT_NE(said.code, 0);
  EXPECT_THAT(said.err, AllOf(HasSubstr("no column 'name'"), HasSubstr("names.csv"), HasSubstr("summit")));
}

TEST_F(Peaks, QuietSaysNothing) {
  table({twins(), "-q"});
  EXPECT_EQ(last_summary_, "");
}

TEST_F(Peaks, OptionsReachTheStages) {
  EXPECT_THAT(table({twins(), "--min-prominence", "400"}), Not(HasSubstr(",700,")));
  EXPECT_THAT(table({twins(), "--min-isolation=5000"}), Not(HasSubstr(",700,")));
  EXPECT_THAT(table({twins(), "--base", "none"}), HasSubstr(",900,,,,"));
}

TEST_F(Peaks, TilesAndThreadsDoNotChangeTheTable) {
  const std::string dem = rolling();
  const std::string one = table({dem, "--threads", "1", "--tile-cells", "16384"});
  EXPECT_GT(std::ranges::count(one, '\n'), 50);
  EXPECT_EQ(table({dem, "--threads", "2", "--tile-cells", "64"}), one);
  EXPECT_EQ(table({dem, "--threads", "1", "--tile-cells", "100"}), one);
}

TEST_F(Peaks, PrintedJobGivesTheSameMap) {
  const std::string dem = rolling();
  const std::string direct = table({dem, "--min-prominence", "50", "--nodata", "unknown"});
  const Outcome printed =
      waymark({"peaks", dem, "--min-prominence", "50", "--nodata", "unknown", "--print-job"});
  write_text(folder_ / "job.json", printed.out);
  ASSERT_EQ(waymark({"run", folder_ / "job.json", "-o", folder_ / "job.gpkg"}).code, 0);
  EXPECT_EQ(csv("job.gpkg"), direct);
}

TEST_F(Peaks, SettingsOverrideTheJob) {
  write_text(folder_ / "job.json", waymark({"peaks", twins(), "--print-job"}).out);
  const Outcome said = waymark({"run", folder_ / "job.json", "-o", folder_ / "map.gpkg", "--set",
                                "find_mountain_tops.min_prominence=400"});
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(csv("map.gpkg"), Not(HasSubstr(",700,")));
  EXPECT_THAT(
      waymark({"run", folder_ / "job.json", "--check", "--set", "find_mountain_tops.min_prominense=4"}).err,
      HasSubstr("'min_prominence'"));
}

TEST_F(Peaks, CheckMakesNothing) {
  const Outcome said = waymark({"peaks", twins(), "--check"});
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, HasSubstr("the job is sound: 5 stages, 5 units of work, 0 of them done"));
  EXPECT_EQ(waymark({"peaks", folder_ / "no.tif", "--check"}).code, 1);
}

TEST_F(Peaks, CheckRefusesPlanarDistancesInDegrees) {
  MadeDem degrees = twin_peaks();
  degrees.crs = "EPSG:4326";
  degrees.geotransform = {8, 0.01, 0, 47, 0, -0.01};
  const std::string dem = make_dem(folder_ / "degrees.tif", degrees);
  for (const std::string how : {"--check", "-q"}) {
    const Outcome said = waymark({"peaks", dem, "-o", folder_ / "map.gpkg", "--distance", "planar", how});
    EXPECT_EQ(said.code, 2) << how;
    EXPECT_THAT(said.err, AllOf(HasSubstr("planar isolation needs a projected DEM"),
                                HasSubstr("gdalwarp -t_srs EPSG:32632"), Not(HasSubstr("join_mountain"))));
  }
}

// A void on the ridge at 500 m may hide a mountain: the first summit is then 600 m prominent, the second 200
// m.
TEST_F(Peaks, VoidsInTheMountainsLowerConfidenceAndAreReported) {
  MadeDem dem = twin_peaks();
  dem.height = [](int column, int row) {
    constexpr std::array ridge = {0, 900, 300, 700, 500, -9999, 0};
    return row == 1 ? ridge.at(static_cast<std::size_t>(column)) : 0.0;
  };
  table({make_dem(folder_ / "holed.tif", dem)});
  EXPECT_THAT(last_summary_,
              AllOf(HasSubstr("4.8 % of the cells have no height"), HasSubstr("--nodata fill"),
                    HasSubstr("--nodata unknown"), HasSubstr("2 of 2 summits may be less prominent")));
  const auto tops = json::parse(
      waymark({"query", folder_ / "map.gpkg", "--largest", "prominence", "--format", "json"}).out);
  EXPECT_EQ(tops[1]["prominence"], 400);
  EXPECT_EQ(tops[1]["prominence_low"], 200);
  EXPECT_EQ(tops[1]["confidence"], 0.5);
}

TEST_F(Peaks, HeightsNoBodyHasAreReportedAndTheMapIsValid) {
  MadeDem dem = twin_peaks();
  dem.height = [old = dem.height](int column, int row) {
    return column == 6 && row == 2 ? 9e9 : old(column, row);
  };
  table({make_dem(folder_ / "spike.tif", dem)});
  EXPECT_THAT(last_summary_,
              AllOf(HasSubstr("1 cells hold numbers that no body's terrain reaches, e.g. 9e+09 m at "
                              "(506500, 5197500)"),
                    HasSubstr("map.gpkg: 2 mountain_top")));
  EXPECT_EQ(waymark({"validate", folder_ / "map.gpkg"}).code, 0);
}

TEST_F(Peaks, FilledVoidsAreCounted) {
  MadeDem dem = twin_peaks();
  dem.height = [old = dem.height](int column, int row) {
    return column == 3 && row == 1 ? -9999 : old(column, row);
  };
  table({make_dem(folder_ / "holed.tif", dem), "--nodata", "fill", "--fill-distance", "5"});
  EXPECT_THAT(last_summary_, HasSubstr("1 cells without height (4.8 %) were interpolated; 0 (0 %)"));
}

TEST_F(Peaks, VoidsNearlyEverywhereAreAPercentageWithoutAnExponent) {
  MadeDem dem{.columns = 60, .rows = 50, .height = [](int column, int row) {
                return column / 4 == 7 && row / 4 == 6 ? 100.0 + column * row : -9999.0;
              }};
  table({make_dem(folder_ / "island.tif", dem), "--nodata", "fill", "--fill-distance", "1"});
  EXPECT_THAT(last_summary_, AllOf(HasSubstr("(98.9 %) are too far from data"), Not(HasSubstr("e+"))));
}

TEST_F(Peaks, AFewVoidsAreNoZeroPercent) {
  MadeDem dem{.columns = 60, .rows = 50, .height = [](int column, int row) {
                return column == 30 && row == 20 ? -9999.0 : 100.0 + column * row;
              }};
  table({make_dem(folder_ / "hole.tif", dem), "--nodata", "fill", "--fill-distance", "5"});
  EXPECT_THAT(last_summary_, HasSubstr("1 cells without height (under 0.1 %) were interpolated"));
}

TEST_F(Peaks, AreaOfInterestKeepsSummitsMeasuredOnTheWholeDem) {
  write_text(folder_ / "area.geojson",
             R"({"type": "FeatureCollection",
                 "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}},
                 "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates":
                 [[[504900, 5198000], [506000, 5198000], [506000, 5199000], [504900, 5198000]]]}}]})");
  const std::string rows = table({twins(), "--distance", "planar", "--aoi", folder_ / "area.geojson"});
  EXPECT_THAT(rows, AllOf(HasSubstr(",700,"), HasSubstr(",4000,"), Not(HasSubstr(",900,"))));
  EXPECT_THAT(last_summary_, HasSubstr("outside the area of interest"));
}

TEST_F(Peaks, HeightsHaveTheUnitAndBandOfTheUser) {
  MadeDem dem = twin_peaks();
  dem.bands = 2;
  const std::string file = make_dem(folder_ / "bands.tif", dem);
  EXPECT_EQ(waymark({"peaks", file, "-o", folder_ / "map.gpkg"}).code, 1);
  EXPECT_THAT(table({file, "--band", "2", "--height-unit", "ft"}), HasSubstr(",274.32,"));
  EXPECT_THAT(table({file, "--band", "1", "--height-scale", "2"}), HasSubstr(",1800,"));
}

TEST_F(Peaks, DemComesByStandardInput) {
  const std::string file = twins(), map = folder_ / "piped.gpkg";
  const std::string direct = table({file});
  for (const std::string name : {"-", "/vsistdin/"}) {
    const Outcome piped = bash("cat '" + file + "' | $WAYMARK peaks " + name + " -o '" + map + "'");
    EXPECT_EQ(piped.code, 0) << piped.err;
    EXPECT_EQ(csv("piped.gpkg"), direct);
  }
  EXPECT_THAT(bash("$WAYMARK peaks - -o '" + map + "' < /dev/null").err,
              HasSubstr("standard input is empty"));
}

TEST_F(Peaks, WorkFolderIsUsedAgain) {
  const std::string dem = rolling();
  const std::string first = table({dem, "--work", folder_ / "work", "--tile-cells", "100"});
  const std::string second = table({dem, "--work", folder_ / "work", "--tile-cells", "100"});
  EXPECT_EQ(first, second);
  EXPECT_THAT(waymark({"peaks", dem, "--work", folder_ / "work", "--tile-cells", "100", "--check"}).err,
              HasSubstr("15 units of work, 15 of them done"));
}

TEST_F(Peaks, SharesMeetInTheWorkFolder) {
  const std::string dem = rolling(), job = folder_ / "job.json", work = folder_ / "work";
  write_text(job, waymark({"peaks", dem, "--tile-cells", "100", "--print-job"}).out);
  ASSERT_EQ(waymark({"run", job, "--work", work, "--shard", "2/2"}).code, 0);
  ASSERT_EQ(waymark({"run", job, "--work", work, "--shard", "1/2"}).code, 0);
  ASSERT_EQ(waymark({"run", job, "--work", work, "-o", folder_ / "shares.gpkg"}).code, 0);
  EXPECT_EQ(csv("shares.gpkg"), table({dem}));
}

TEST_F(Peaks, PlanNamesEveryUnit) {
  write_text(folder_ / "job.json", waymark({"peaks", rolling(), "--tile-cells", "100", "--print-job"}).out);
  const auto plan = [&](const std::string& form) {
    return waymark({"plan", folder_ / "job.json", "--as", form, "--work", folder_ / "work"}).out;
  };
  EXPECT_EQ(std::ranges::count(plan("jsonl"), '\n'), 15);
  EXPECT_THAT(plan("snakemake"), HasSubstr("rule "));
  EXPECT_THAT(plan("slurm"), HasSubstr("sbatch"));
}

// Stands for GNU parallel where it is absent: one shard after the other.
TEST_F(Peaks, APlanEndsInTheMap) {
  const std::string dem = rolling(), job = folder_ / "job.json";
  write_text(job, waymark({"peaks", dem, "--tile-cells", "100", "--print-job"}).out);
  write_text(folder_ / "parallel",
             "#!/bin/sh\nshift 2\nwhile read -r i; do sh -c \"$(echo \"$1\" | sed \"s/{}/$i/\")\" || exit 1; "
             "done\n");
  const Outcome ran =
      bash("cd '" + folder_.path().string() + "' && chmod +x parallel && ln -s \"$WAYMARK\" waymark && " +
           "PATH=$PWD:$PATH && " +
           "$WAYMARK plan job.json --as parallel -o plan.gpkg --set find_mountain_tops.min_prominence=20" +
           " > run.sh && sh run.sh");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(csv("plan.gpkg"), table({dem, "--min-prominence", "20"}));
}

TEST_F(Peaks, ProgressHasItsForms) {
  const std::string dem = twins();
  const auto said = [&](const std::string& form) {
    return waymark({"peaks", dem, "-o", folder_ / "map.gpkg", "--progress", form}).err;
  };
  EXPECT_THAT(
      said("dots"),
      HasSubstr("find_mountain_tops: 0...10...20...30...40...50...60...70...80...90...100 - done.\n"));
  EXPECT_THAT(said("bar"), HasSubstr("[########################] 100 %"));
  EXPECT_THAT(said("json"), HasSubstr(R"({"stage":"find_mountain_tops","done":1.0,"total":1,)"));
  for (const char* silent : {"none", "auto"})  // auto: no terminal here
    EXPECT_THAT(said(silent), testing::StartsWith("stage  "));
}

TEST_F(Peaks, RunIsRecordedInTheMap) {
  table({twins(), "--min-prominence", "30"});
  const std::string run = bash("ogrinfo -q " + (folder_ / "map.gpkg") + " run 2>&1").out;
  if (run.empty()) GTEST_SKIP() << "ogrinfo is not installed";
  EXPECT_THAT(run, AllOf(HasSubstr("waymark peaks"), HasSubstr("--min-prominence 30"),
                         HasSubstr("find_mountain_tops"), HasSubstr("twins.tif")));
}

TEST_F(Peaks, ValidMapExportsAndReports) {
  table({twins(), "--with-dem"});
  const std::string map = folder_ / "map.gpkg";
  const Outcome valid = waymark({"validate", map});
  EXPECT_EQ(valid.code, 0) << valid.out;
  EXPECT_EQ(valid.out, "");
  const std::string geojson = folder_ / "tops.geojson";
  EXPECT_EQ(waymark({"export", map, geojson}).code, 0);
  EXPECT_EQ(json::parse(text_of(geojson))["features"].size(), 2);
  const Outcome again = waymark({"export", map, geojson});
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.err, AllOf(HasSubstr("exists"), HasSubstr("--overwrite")));
  EXPECT_EQ(waymark({"export", map, geojson, "--overwrite", "-of", "GeoJSON"}).code, 0);
  EXPECT_EQ(waymark({"report", map, "-o", folder_ / "report.html"}).code, 0);
  EXPECT_THAT(text_of(folder_ / "report.html"), HasSubstr("mountain_top"));
}

TEST_F(Peaks, ValidateNamesTheFaultsAndFails) {
  table({twins()});
  const std::string map = folder_ / "map.gpkg";
  sqlite3* file = nullptr;
  ASSERT_EQ(sqlite3_open(map.c_str(), &file), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(file, "DELETE FROM rtree_mountain_top_geom WHERE id = 1", nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(file);
  const Outcome said = waymark({"validate", map});
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.out, testing::StartsWith("rtree.row\tmountain_top\t1\t"));
  const Outcome as_json = waymark({"validate", map, "--format", "json"});
  EXPECT_EQ(as_json.code, 1);
  const json fault = json::parse(as_json.out).at(0);
  EXPECT_EQ(fault["code"], "rtree.row");
  EXPECT_EQ(fault["table"], "mountain_top");
  EXPECT_EQ(fault["row"], 1);
  EXPECT_FALSE(fault["text"].get<std::string>().empty());
}

TEST_F(Peaks, ResultsOfARunAreJsonOnRequest) {
  const std::string dem = twins(), map = folder_ / "map.gpkg";
  const Outcome said = waymark({"peaks", dem, "-o", map, "--format", "json"});
  ASSERT_EQ(said.code, 0) << said.err;
  const json done = json::parse(said.out);
  EXPECT_EQ(done["map"], map);
  EXPECT_EQ(done["landmarks"], json({{"mountain_top", 2}}));
  ASSERT_EQ(done["inputs"].size(), 1);
  EXPECT_EQ(done["inputs"][0]["path"], dem);
  EXPECT_EQ(done["inputs"][0]["sha256"].get<std::string>().size(), 64);
  EXPECT_EQ(done["run"]["stages"][0]["stage"], "load_dem");
  const json checked = json::parse(waymark({"peaks", dem, "--check", "--format", "json"}).out);
  EXPECT_EQ(checked["map"], nullptr);
  EXPECT_EQ(waymark({"validate", map, "--format", "json"}).out, "[]\n");
}

}  // namespace
}  // namespace waymark::test
