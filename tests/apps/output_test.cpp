// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "made_dem.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Output : public testing::Test {
 protected:
  std::string twins() { return make_dem(folder_ / "twins.tif", twin_peaks()); }
  Outcome peaks(const std::string& dem, const std::string& map) { return waymark({"peaks", dem, "-o", map}); }
  /// True if tmpfs can be mounted in a name space of our own.
  static bool can_mount() { return bash("unshare -rm mount -t tmpfs none /mnt").code == 0; }

  TempFolder folder_;
};

TEST_F(Output, MissingFolderIsRefusedBeforeAnyWork) {
  const Outcome said =
      peaks(folder_ / "no.tif", folder_ / "no/map.gpkg");  // the DEM is missing too: not looked at
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, AllOf(HasSubstr("the folder of the output does not exist"), HasSubstr("mkdir -p")));
}

TEST_F(Output, OtherExtensionIsRefused) {
  const Outcome said = peaks(twins(), folder_ / "map.tif");
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, AllOf(HasSubstr("ends in .gpkg"), HasSubstr("map.gpkg")));
}

TEST_F(Output, ReadOnlyFolderIsRefused) {
  if (!can_mount()) GTEST_SKIP() << "mounting is not permitted";
  const Outcome said = bash("cd " + folder_.path().string() + " && mkdir ro && unshare -rm bash -c '" +
                            "mount -t tmpfs -o ro none ro && $WAYMARK peaks " + twins() + " -o ro/map.gpkg'");
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, HasSubstr("the folder of the output cannot be written: ro (Read-only file system)"));
}

TEST_F(Output, OlderMapIsReplaced) {
  const std::string map = folder_ / "map.gpkg";
  ASSERT_EQ(peaks(twins(), map).code, 0);
  ASSERT_EQ(peaks(make_dem(folder_ / "hills.tif", hills(100, 100)), map).code, 0);
  EXPECT_THAT(waymark({"query", map, "--format", "csv"}).out, Not(HasSubstr(",900,")));
}

TEST_F(Output, ForeignFileIsNeverReplaced) {
  const std::string map = folder_ / "map.gpkg";
  write_text(map, "a year of work");
  const Outcome said = peaks(twins(), map);
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, AllOf(HasSubstr("not replaced"), HasSubstr(map)));
  EXPECT_EQ(text_of(map), "a year of work");
}

TEST_F(Output, AnInputIsNeverReplaced) {
  const std::string map = folder_ / "map.gpkg", dem = twins(), log = folder_ / "log.jsonl",
                    area = folder_ / "area.geojson";
  write_text(folder_ / "rocks.csv", "x,y,radius,height\n501500,5198500,0.5,0.5\n502500,5198000,0.5,0.5\n");
  ASSERT_EQ(
      waymark({"import", folder_ / "rocks.csv", "-o", map, "--type", "rock", "--map-crs", "EPSG:32632"}).code,
      0);
  write_text(log, R"({"kind":"header","version":1,"start":{"x":0,"y":0,"yaw":0}}
{"kind":"odometry","t":0,"v":0.5,"omega":0}
{"kind":"sightings","t":0.4,"items":[{"type":"rock","range":6.2,"bearing":0.1}]}
)");
  write_text(area, R"({"type":"Polygon","coordinates":[[[5e5,5.1e6],[6e5,5.1e6],[6e5,5.3e6],[5e5,5.1e6]]]})");
  const std::vector<std::vector<std::string>> commands{
      {"peaks", map, "-o", map},
      {"export", map, map, "--overwrite"},
      {"export", map, map, "--overwrite", "-of", "beluga"},
      {"import", map, "--rules", "trees", "-o", map},
      {"report", map, "-o", map},
      {"report", map, "-o", area, "--aoi", area},
      {"view", map, "--dem", dem, "-o", map},
      {"view", map, "--dem", dem, "-o", dem},
      {"hazards", dem, "-o", dem},
      {"hazards", map, "--dem", dem, "-o", dem},
      {"observability", map, "--dem", dem, "--sensor", "horizontal_laser", "-o", dem},
      {"route", map, "--from", "501500,5198500", "--to", "501540,5198500", "--sensor", "horizontal_laser",
       "--least-sigma", "--aoi", area, "-o", area},
      {"localize", map, log, "-o", map},
      {"localize", map, log, "-o", folder_ / "t.csv", "--method", "slam", "--write-map", map},
      {"map", log, "--poses", map, "-o", map},
      {"merge", map, map, "-o", map},
      {"stac", area, "-o", area}};
  const std::string map_before = text_of(map), dem_before = text_of(dem), area_before = text_of(area);
  for (const std::vector<std::string>& command : commands) {
    const Outcome said = waymark(command);
    EXPECT_NE(said.code, 0) << command[0];
    EXPECT_THAT(said.err, HasSubstr("the output would replace the input")) << command[0];
    ASSERT_EQ(text_of(map), map_before) << command[0];
    ASSERT_EQ(text_of(dem), dem_before) << command[0];
    ASSERT_EQ(text_of(area), area_before) << command[0];
  }
}

TEST_F(Output, AFileIsNoFolder) {
  const std::string dem = twins(), file = folder_ / "file";
  write_text(file, "a year of work");
  const std::string map = folder_ / "map.gpkg";
  ASSERT_EQ(peaks(dem, map).code, 0);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"stac", map, "-o", file}, {"web", map, "-o", file}}) {
    const Outcome said = waymark(command);
    EXPECT_EQ(said.code, 1);
    EXPECT_THAT(said.err, Not(HasSubstr("fault of waymark"))) << command[0];
    EXPECT_THAT(said.err, HasSubstr(file)) << command[0];
  }
}

TEST_F(Output, AnEmptyFileIsReplaced) {
  const std::string map = folder_ / "map.gpkg";  // as mktemp makes it
  write_text(map, "");
  const Outcome said = peaks(twins(), map);
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_EQ(waymark({"validate", map}).code, 0);
}

TEST_F(Output, SourceDateEpochGivesTheSameBytes) {
  const std::string dem = twins(), map = folder_ / "map.gpkg";
  const auto run = [&](const std::string& command) {
    const Outcome said =
        bash("export SOURCE_DATE_EPOCH=1700000000; cd " + folder_.path().string() + "; " + command);
    EXPECT_EQ(said.code, 0) << said.err;
    return text_of(map);
  };
  write_text(folder_.path() / "rocks.csv", "x,y,radius\n1,1,3\n2,9,3\n");
  for (const std::string& command :
       {"$WAYMARK peaks " + dem + " -o map.gpkg",
        std::string("$WAYMARK import rocks.csv --type rock --map-crs local -o map.gpkg")}) {
    const std::string once = run(command), again = run("sleep 1.1; " + command);
    EXPECT_GT(once.size(), 50'000u);
    EXPECT_TRUE(once == again) << command;
  }
  EXPECT_THAT(bash("SOURCE_DATE_EPOCH=1.5 $WAYMARK peaks " + dem + " -o " + map).err,
              HasSubstr("SOURCE_DATE_EPOCH"));
}

TEST_F(Output, AnInterruptedRunSaysSo) {
  const std::string map = folder_ / "map.gpkg", dem = make_dem(folder_ / "hills.tif", hills(1500, 1500));
  const Outcome said = bash("$WAYMARK peaks " + dem + " -o " + map +
                            " --min-prominence 0 --threads 1 & run=$!; "
                            "sleep 0.3; kill -INT $run; wait $run; exit $?");
  if (said.code == 0) GTEST_SKIP() << "the run ended before the interrupt";
  EXPECT_EQ(said.code, 130);
  EXPECT_THAT(said.err, AllOf(HasSubstr("error: interrupted"), HasSubstr("--work")));
  EXPECT_FALSE(std::filesystem::exists(map));
}

TEST_F(Output, FullDiskLeavesTheOldMap) {
  if (!can_mount()) GTEST_SKIP() << "mounting is not permitted";
  const std::string map = folder_ / "map.gpkg", dem = make_dem(folder_ / "hills.tif", hills(400, 400));
  ASSERT_EQ(peaks(twins(), map).code, 0);
  const auto bytes = std::to_string(std::filesystem::file_size(map) + 65536);
  const Outcome said = bash("cd " + folder_.path().string() + " && mkdir small && unshare -rm bash -c '" +
                            "mount -t tmpfs -o size=" + bytes + " none small && cp map.gpkg small/ && " +
                            "$WAYMARK peaks " + dem + " -o small/map.gpkg --min-prominence 0; code=$?; " +
                            "cmp map.gpkg small/map.gpkg && ls -A small; exit $code'");
  EXPECT_EQ(said.code, 1);
  EXPECT_EQ(said.out, "map.gpkg\n");  // unchanged, and nothing beside it
  EXPECT_THAT(said.err, AllOf(HasSubstr("small/map.gpkg"), HasSubstr("full")));
}

TEST_F(Output, KilledRunLeavesTheOldMapAndTheNextOneGoesOn) {
  const std::string map = folder_ / "map.gpkg", dem = make_dem(folder_ / "hills.tif", hills(1500, 1500));
  ASSERT_EQ(peaks(twins(), map).code, 0);
  const std::string old = text_of(map);
  const std::vector<std::string> words{"peaks",
                                       dem,
                                       "-o",
                                       map,
                                       "--work",
                                       folder_ / "work",
                                       "--tile-cells",
                                       "128",
                                       "-q",
                                       "--threads",
                                       "1",
                                       "--min-prominence",
                                       "0"};
  for (const int milliseconds : {60, 100, 150, 220, 300}) {
    const pid_t run = start_waymark(words);
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(run, SIGKILL);
    waitpid(run, nullptr, 0);
    if (text_of(map) != old) {
      ASSERT_EQ(waymark({"validate", map}).code, 0) << "killed after " << milliseconds << " ms";
    }
  }
  ASSERT_EQ(waymark(words).code, 0);
  ASSERT_EQ(waymark({"peaks", dem, "-o", folder_ / "fresh.gpkg", "--min-prominence", "0"}).code, 0);
  EXPECT_EQ(waymark({"query", map, "--format", "csv"}).out,
            waymark({"query", folder_ / "fresh.gpkg", "--format", "csv"}).out);
}

}  // namespace
}  // namespace waymark::test
