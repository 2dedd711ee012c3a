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
