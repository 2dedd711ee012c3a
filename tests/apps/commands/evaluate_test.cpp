// SPDX-License-Identifier: Apache-2.0
// What `waymark evaluate` says where nothing matches.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <utility>

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

// A drive of 20 m along the grid's north, 3 km from the origin of zone 33: a track with --crs was compared
// with the frame of the map as it stood.
TEST_F(Evaluate, TracksInACrsAreConvertedOrRefused) {
  const std::string map = folder_ / "m.gpkg";
  ASSERT_EQ(waymark({"import",
                     file("rocks.csv", "x,y,radius,height\n300000,5200000,0.5,0.6\n300020,5200000,0.5,0.6\n"),
                     "-o", map, "--type", "rock", "--map-crs", "EPSG:32633"})
                .code,
            0);
  std::string log =
      R"({"kind":"header","version":1,"frame":"crs","crs":"EPSG:32633","start":{"x":300000,"y":5200000,"yaw":1.5707963}})"
      "\n";
  for (int i = 0; i <= 20; ++i)
    log += R"({"kind":"step","t":)" + std::to_string(i) + R"(,"dx":)" + (i ? "1" : "0") +
           R"(,"dy":0,"dyaw":0})"
           "\n" +
           R"({"kind":"truth","t":)" + std::to_string(i) + R"(,"x":300000,"y":)" +
           std::to_string(5200000 + i) +
           R"(,"yaw":1.5707963})"
           "\n";
  const std::string drive = file("drive.jsonl", log);
  const auto localize = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words{"localize", map, drive, "--method", "odometry", "-o", folder_ / name};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome said = waymark(words);
    EXPECT_EQ(said.code, 0) << said.err;
    return folder_ / name;
  };
  const std::string in_frame = localize("frame.csv", {}), in_crs = localize("crs.csv", {"--crs"});
  EXPECT_THAT(text_of(in_crs), HasSubstr(",EPSG:32633\n"));
  const auto evaluate = [&](const std::string& track, const std::string& truth,
                            const std::vector<std::string>& more) {
    std::vector<std::string> words{"evaluate",  "track", track,      "--truth", truth,
                                   "--max-gap", "2",     "--format", "json"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  };
  const Outcome a = evaluate(in_frame, drive, {"--map", map}), b = evaluate(in_crs, drive, {"--map", map});
  ASSERT_EQ(b.code, 0) << b.err;
  const auto error = [](const Outcome& said) {
    return nlohmann::json::parse(said.out)["ate_rmse"].get<double>();
  };
  EXPECT_LT(error(a), 0.1);
  EXPECT_NEAR(error(a), error(b), 2e-3);
  const Outcome alike = evaluate(in_crs, drive, {});  // both in the CRS
  ASSERT_EQ(alike.code, 0) << alike.err;
  EXPECT_LT(error(alike), 0.1);
  EXPECT_NEAR(error(evaluate(in_frame, in_crs, {"--map", map})), 0, 1e-3) << "a truth of the same kind";
  for (const auto& [track, truth] :
       {std::pair(in_frame, drive), std::pair(in_crs, in_frame), std::pair(in_frame, in_crs)}) {
    const Outcome said = evaluate(track, truth, {});
    EXPECT_EQ(said.code, 2) << track << ' ' << truth;
    EXPECT_THAT(said.err,
                AllOf(HasSubstr("EPSG:32633"), HasSubstr("the frame of a map"), HasSubstr("--map")));
  }
}

TEST_F(Evaluate, ANegativeGapIsRefused) {
  const std::string track = file("t.csv", "t,x,y,yaw\n0,0,0,0\n1,1,0,0\n");
  for (const char* gap : {"-1", "nan"}) {
    const Outcome said = waymark({"evaluate", "track", track, "--truth", track, "--max-gap", gap});
    EXPECT_EQ(said.code, 2) << gap;
    EXPECT_THAT(said.err, HasSubstr("--max-gap"));
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
