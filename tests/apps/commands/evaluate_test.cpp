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
