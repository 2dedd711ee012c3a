// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_bearings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace waymark::test {
using namespace localization;
namespace {

TEST(CloudBearings, MatchASearchOfAllPoints) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> any(-30, 30);
  std::vector<Eigen::Vector3f> points(2000);
  for (Eigen::Vector3f& p : points) p = {any(random), any(random), any(random) / 10};
  const CloudBearings cloud(points);
  for (const double bearing : {-3.14, -1.0, 0.0, 0.004, 2.2, 3.14})
    for (const double reach : {0.0, 0.003, 0.1, 1.5}) {
      std::vector<float> ranges, expected;
      cloud.within(bearing, reach, [&](double off, double slope, double range) {
        EXPECT_LE(std::abs(off), reach);
        EXPECT_LT(std::abs(slope * range), 3.01);
        ranges.push_back(static_cast<float>(range));
      });
      for (const Eigen::Vector3f& p : points)
        if (std::abs(std::remainder(static_cast<double>(std::atan2(p.y(), p.x())) - bearing,
                                    2 * std::numbers::pi)) <= reach)
          expected.push_back(p.head<2>().norm());
      std::ranges::sort(ranges), std::ranges::sort(expected);
      EXPECT_EQ(ranges, expected) << bearing << ' ' << reach;
    }
}

TEST(CloudBearings, LeaveOutWhatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<Eigen::Vector3f> points = {{nan, 0, 0}, {inf, 1, 0}, {0, 0, 1}, {1, 0, nan}, {2, 0, 1}};
  int seen = 0;
  CloudBearings(points).within(0, 3, [&](double off, double slope, double range) {
    ++seen;
    EXPECT_EQ(off, 0);
    EXPECT_EQ(slope, 0.5);
    EXPECT_EQ(range, 2);
  });
  EXPECT_EQ(seen, 1);
}

}  // namespace
}  // namespace waymark::test
