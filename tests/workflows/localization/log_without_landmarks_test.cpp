// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/log_without_landmarks.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace waymark::test {
using namespace localization;
using workflows::dead_reckoning_warning;
using workflows::unusable_ranges_warning;
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr float kNoReturn = std::numeric_limits<float>::quiet_NaN();

RobotLog log_of_scans(const std::vector<float>& ranges) {
  LaserScan scan;
  scan.ranges = ranges, scan.max_range = 30;
  RobotLog log;
  for (int i = 0; i < 5; ++i) log.events.push_back({.t = 0.5 * i, .what = scan});
  return log;
}

TEST(LogWithoutLandmarks, RangesInMillimetresAreNamed) {
  EXPECT_THAT(unusable_ranges_warning(log_of_scans({5100, 7200, kNoReturn})),
              AllOf(HasSubstr("0 of 10 ranges of the 5 laser scans lie below the scanner's 30 m"),
                    HasSubstr("begin at 5100"), HasSubstr("ranges are metres")));
  EXPECT_THAT(unusable_ranges_warning(log_of_scans({kNoReturn, 0, -1})),
              HasSubstr("none of the 15 beams of the 5 laser scans has a range above 0"));
}

TEST(LogWithoutLandmarks, ScansOfZerosAmongOthersAreNamed) {
  RobotLog log = log_of_scans({5, 7, kNoReturn});
  for (const int i : {2, 3}) std::get<LaserScan>(log.events[std::size_t(i)].what).ranges = {0, 0, -1};
  EXPECT_EQ(unusable_ranges_warning(log),
            "2 of the 5 laser scans, at 1.000 to 1.500 s, have no range above 0 and show nothing");
  for (const int i : {2, 3}) std::get<LaserScan>(log.events[std::size_t(i)].what).ranges = {kNoReturn};
  EXPECT_EQ(unusable_ranges_warning(log), "");  // nothing in range
}

TEST(LogWithoutLandmarks, ScansInTheOpenAreNotNamed) {
  std::vector<float> open(400, 81.91F);  // how some scanners write a beam without a return
  open[7] = 12;
  EXPECT_EQ(unusable_ranges_warning(log_of_scans(open)), "");
  EXPECT_EQ(unusable_ranges_warning(RobotLog()), "");
}

TEST(LogWithoutLandmarks, ATrackWithoutSightingsIsDeadReckoning) {
  EXPECT_THAT(dead_reckoning_warning(log_of_scans({3, 4}), {}),
              AllOf(HasSubstr("no landmark is detected in the 5 laser scans"), HasSubstr("scans=NAME"),
                    HasSubstr("the track is dead reckoning")));
  RobotLog empty_sets;
  empty_sets.events.push_back({.t = 0, .what = SightingSet{}});
  EXPECT_THAT(dead_reckoning_warning(empty_sets, {}),
              HasSubstr("the 1 sets of sightings of the log are empty"));
  Track fixed;
  fixed.fixes = 3;
  EXPECT_THAT(dead_reckoning_warning(RobotLog(), fixed),
              AllOf(HasSubstr("no sightings and no scans"), HasSubstr("dead reckoning with fixes")));
  Track seen;
  seen.verdicts[1] = 1;
  EXPECT_EQ(dead_reckoning_warning(RobotLog(), seen), "");
}

}  // namespace
}  // namespace waymark::test
