// SPDX-License-Identifier: Apache-2.0
#include "localization/drive_statistics.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace waymark::test {
using namespace localization;
namespace {

// Tables of the sign test: of 10 values the 2nd and the 9th, of 30 the 10th and the 21st.
TEST(DriveStatistics, IntervalOfTheMedianIsThatOfTheSignTest) {
  std::vector<double> ten, thirty;
  for (int i = 1; i <= 30; ++i) {
    thirty.push_back(31 - i);
    if (i <= 10) ten.push_back(i);
  }
  EXPECT_DOUBLE_EQ(spread_over_drives(ten).median, 5.5);
  EXPECT_DOUBLE_EQ(spread_over_drives(ten).low, 2);
  EXPECT_DOUBLE_EQ(spread_over_drives(ten).high, 9);
  EXPECT_DOUBLE_EQ(spread_over_drives(thirty).low, 10);
  EXPECT_DOUBLE_EQ(spread_over_drives(thirty).high, 21);
  const SpreadOverDrives few = spread_over_drives({3, 1, 2});
  EXPECT_DOUBLE_EQ(few.low, 1);
  EXPECT_DOUBLE_EQ(few.high, 3);
}

TEST(DriveStatistics, TheIntervalHoldsTheMedianAsOftenAsItSays) {
  Random random(1, "drives");
  int held = 0;
  for (int study = 0; study < 2000; ++study) {
    std::vector<double> drives;
    for (int i = 0; i < 12; ++i) drives.push_back(std::exp(random.normal()));  // median 1
    const SpreadOverDrives s = spread_over_drives(drives);
    held += s.low <= 1 && 1 <= s.high;
  }
  EXPECT_GT(held, 1880);  // 96.1 % by the binomial distribution; 3 standard deviations are 1.3 %
  EXPECT_LT(held, 1960);
}

TEST(DriveStatistics, BandsAreQuantilesOverDrives) {
  std::vector<std::vector<TrackErrorAt>> drives;
  for (int d = 0; d <= 20; ++d) {
    std::vector<TrackErrorAt> drive;
    for (int i = 0; i <= (d == 0 ? 100 : 50); ++i) drive.push_back({0.1 * i, 0.01 * d, 0.2});
    drives.push_back(drive);
  }
  const std::vector<ErrorBand> bands = error_bands(drives, 10);
  ASSERT_EQ(bands.size(), 10u);
  EXPECT_EQ(bands[0].drives, 21u);
  EXPECT_NEAR(bands[0].p5, 0.01, 1e-12);
  EXPECT_NEAR(bands[0].median, 0.1, 1e-12);
  EXPECT_NEAR(bands[0].p95, 0.19, 1e-12);
  EXPECT_NEAR(bands[0].claimed, 0.2, 1e-12);
  EXPECT_EQ(bands[9].drives, 1u) << "the others have ended";
}

}  // namespace
}  // namespace waymark::test
