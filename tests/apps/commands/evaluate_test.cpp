// SPDX-License-Identifier: Apache-2.0
// What `waymark evaluate` says where nothing matches.
#include <gmock/gmock.h>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Evaluate : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) {
    write_text(folder_.path() / name, text);
    return folder_ / name;
  }
  TempFolder folder_;
};

TEST_F(Evaluate, WhatMatchesNothingIsReportedWithBothExtents) {
  const Outcome said = waymark({"evaluate", "landmarks", file("a.csv", "x,y,radius\n500000,5200000,1\n"),
                                "--truth", file("b.csv", "x,y,radius\n900000.5,5900000,1\n")});
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, AllOf(HasSubstr("x 500000 to 500000, y 5200000 to 5200000"),
                              HasSubstr("x 900000.5 to 900000.5, y 5900000 to 5900000"),
                              HasSubstr("in one coordinate system?"), Not(HasSubstr("e+"))));
}

TEST_F(Evaluate, TruthWithoutRowsIsReported) {
  const Outcome said = waymark({"evaluate", "landmarks", file("a.csv", "x,y,radius\n1,2,1\n"), "--truth",
                                file("none.csv", "x,y,radius\n")});
  EXPECT_THAT(said.err, AllOf(HasSubstr("none.csv has no landmarks"), HasSubstr("nothing can be compared")));
}

TEST_F(Evaluate, OptionsOfTheOtherAreRefused) {
  const std::string table = file("a.csv", "x,y,radius\n1,2,1\n"),
                    track = file("t.csv", "t,x,y,yaw\n0,0,0,0\n");
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--align", "se2"}, {"--map", "m.gpkg"}, {"--drive", "a=b"}}) {
    std::vector<std::string> words{"evaluate", "landmarks", table, "--truth", table};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_THAT(waymark(words).err, HasSubstr(options[0] + " is no option of `evaluate landmarks`"));
  }
  EXPECT_THAT(waymark({"evaluate", "track", track, "--truth", track, "--tolerance", "2"}).err,
              HasSubstr("--tolerance is no option of `evaluate track`"));
}

TEST_F(Evaluate, RowsWithoutPositionAreReported) {
  const std::string table = file("a.csv", "x,y,radius\n1,2,1\n,5,1\n");
  const Outcome said = waymark({"evaluate", "landmarks", table, "--truth", table});
  EXPECT_NE(said.code, 0);
  EXPECT_THAT(said.err, AllOf(HasSubstr("the row has no position"), HasSubstr("3")));
}

TEST_F(Evaluate, SizesThatDoNotAscendAreRefused) {
  const std::string table = file("a.csv", "x,y,radius\n1,2,1\n");
  EXPECT_THAT(waymark({"evaluate", "landmarks", table, "--truth", table, "--size-edges", "5", "1"}).err,
              HasSubstr("do not ascend"));
  const Outcome said = waymark({"evaluate", "landmarks", table, "--truth", table, "--size-edges", "1", "5"});
  EXPECT_THAT(said.out, AllOf(HasSubstr("1 - 5"), HasSubstr("5 - ")));
}

// The true pose at 0.5 s is 0.5 m from the start, in whatever order the rows are.
TEST_F(Evaluate, TracksAreReadInTheOrderOfTime) {
  const std::string truth = file("truth.csv", "t,x,y,yaw\n2,2,0,0\n0,0,0,0\n1,1,0,0\n");
  const std::string track = file("track.csv", "t,x,y,yaw\n1.5,1.5,0,0\n0.5,0.5,0,0\n");
  const Outcome said =
      waymark({"evaluate", "track", track, "--truth", truth, "--max-gap", "2", "--format", "json"});
  EXPECT_THAT(said.out, HasSubstr("\"poses\": 2"));
  EXPECT_THAT(said.out, HasSubstr("\"ate_rmse\": 0.0,"));
}

// Differences of degrees and of feet would be reported as metres.
TEST_F(Evaluate, TrueCoordinatesThatAreNoMetresNeedTheMap) {
  const std::string track = file("track.csv", "t,x,y,yaw\n0,5,62,0\n1,5,62,0\n");
  for (const std::string crs : {"EPSG:4326", "EPSG:2263"}) {
    const std::string log =
        file("log.jsonl", R"({"kind":"header","version":1,"frame":"crs","crs":")" + crs + "\"}\n" +
                              R"({"kind":"truth","t":0,"x":5,"y":62,"yaw":0})" + "\n" +
                              R"({"kind":"truth","t":1,"x":5,"y":62,"yaw":0})" + "\n");
    const Outcome said = waymark({"evaluate", "track", track, "--truth", log, "--max-gap", "2"});
    EXPECT_NE(said.code, 0) << crs;
    EXPECT_THAT(said.err, AllOf(HasSubstr("are in " + crs + ", which is not in metres"), HasSubstr("--map")));
  }
}

TEST_F(Evaluate, TypesThatNeitherMapHoldsAreLeftOut) {
  const std::string table = file("rocks.csv", "x,y,radius\n1,2,1\n"), map = folder_ / "rocks.gpkg";
  ASSERT_EQ(waymark({"import", table, "-o", map, "--type", "rock", "--map-crs", "local"}).code, 0);
  const Outcome said = waymark({"evaluate", "landmarks", map, "--truth", map});
  EXPECT_THAT(said.out,
              AllOf(testing::StartsWith("rock\n"), Not(HasSubstr("crater")), Not(HasSubstr("wall"))));
}

TEST_F(Evaluate, TimesNoTrackHasAreReportedAsTimes) {
  const std::string track = file("track.csv", "t,x,y,yaw\n0,0,0,0\n1e300,1,0,0\n");
  EXPECT_THAT(waymark({"evaluate", "track", track, "--truth", track}).err,
              AllOf(HasSubstr("t = 1e+300 is not possible in a track"), HasSubstr("track.csv, line 3"),
                    HasSubstr("times are seconds, at most 1e+15 from 0")));
}

}  // namespace
}  // namespace waymark::test
