// SPDX-License-Identifier: Apache-2.0
#include "exporters/formatting.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark::test {
using namespace exporters;
namespace {

const FeatureSpec kElevation{.name = "elevation", .unit = "m", .scale = Scale::interval, .summary = {}};
const FeatureSpec kIsolation{.name = "isolation", .unit = "m", .scale = Scale::ratio, .summary = {}};
const FeatureSpec kOrientation{.name = "orientation", .unit = "rad", .scale = Scale::axis, .summary = {}};

TEST(NumberText, SetsThousandsApartFromFiveDigitsOn) {
  EXPECT_EQ(number_text(4506), "4506");
  EXPECT_EQ(number_text(21134), "21\u202f134");
  EXPECT_EQ(number_text(1234567.25, 1), "1\u202f234\u202f567.2");
}

TEST(NumberText, HasAMinusAndNoNegativeZero) {
  EXPECT_EQ(number_text(-4506), "\u22124506");
  EXPECT_EQ(number_text(-0.04, 1), "0.0");
  EXPECT_EQ(number_text(std::nan("")), "\u2013");
}

TEST(SecondsText, ShortTimesKeepTheirDigits) {
  EXPECT_EQ(seconds_text(0.0042), "0.004\u00a0s");
  EXPECT_EQ(seconds_text(0.307), "0.31\u00a0s");
  EXPECT_EQ(seconds_text(4.25), "4.2\u00a0s");
  EXPECT_EQ(seconds_text(614.6), "615\u00a0s");
}

TEST(NumberFormat, DistancesBecomeKilometresElevationsNever) {
  EXPECT_EQ(number_format(kIsolation, 62732.6)(62732.6), "62.7\u00a0km");
  EXPECT_EQ(number_format(kIsolation, 19000)(534), "534\u00a0m");
  EXPECT_EQ(number_format(kElevation, 21134)(21134), "21\u202f134\u00a0m");
}

TEST(NumberFormat, SmallThingsKeepThreeDigits) {
  EXPECT_EQ(number_format(kIsolation, 0.43)(0.43), "0.430\u00a0m");
  EXPECT_EQ(number_format(kIsolation, 0)(0), "0\u00a0m");
}

TEST(NumberFormat, AnglesAreReadInDegrees) {
  EXPECT_EQ(number_format(kOrientation, 1)(M_PI / 4), "45.0\u00a0\u00b0");
}

TEST(TitleOf, ReadsLikeWords) {
  EXPECT_EQ(title_of("mountain_top"), "Mountain top");
}

TEST(Escaped, LeavesNoMarkup) {
  EXPECT_EQ(escape_markup("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
}

}  // namespace
}  // namespace waymark::test
