// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_curbs.hpp"

#include <gmock/gmock.h>

#include "localization/detectors/scan_landmarks.hpp"
#include "tests/localization/made_street.hpp"

namespace waymark::test {
using namespace localization;
namespace {

TEST(CloudCurbs, OfAllHeightsAreFoundWhereTheyAre) {
  for (const double step : {0.07, 0.12, 0.18, 0.24})
    for (const double away : {3.0, 4.5, 6.0}) {
      const auto curbs = find_curbs(scan_street({.plates = {}, .kerb = away, .step = step}, 1));
      ASSERT_FALSE(curbs.empty()) << step << " m high, " << away << " m away";
      double length = 0;
      for (const CloudCurb& curb : curbs) {  // there may be gaps between its pieces
        EXPECT_NEAR(curb.normal.x(), 0, 4 * std::sqrt(curb.angle_variance));
        EXPECT_NEAR(curb.normal.dot(curb.centre - Eigen::Vector2d(0, away)), 0,
                    3 * std::sqrt(curb.centre_variance))
            << step << " m high";
        EXPECT_LT(std::sqrt(curb.centre_variance), 0.1);
        EXPECT_NEAR(curb.step, step, 0.02);
        length += curb.end - curb.begin;
      }
      EXPECT_GT(length, 5);
    }
}

TEST(CloudCurbs, ErrAsTheyState) {
  double squares = 0, angle_squares = 0;
  constexpr int kScans = 12;
  for (unsigned seed = 0; seed < kScans; ++seed) {
    const auto curbs = find_curbs(scan_street({.plates = {}, .kerb = 4 + 0.13 * seed, .step = 0.12}, seed));
    ASSERT_EQ(curbs.size(), 1U) << "seed " << seed;
    squares += std::pow(curbs[0].normal.dot(curbs[0].centre - Eigen::Vector2d(0, 4 + 0.13 * seed)), 2) /
               curbs[0].centre_variance;
    angle_squares += std::pow(curbs[0].normal.x(), 2) / curbs[0].angle_variance;
  }
  EXPECT_LT(squares / kScans, 2);
  EXPECT_LT(angle_squares / kScans, 2);
}

TEST(CloudCurbs, AreIndependentOfTheOrderOfPoints) {
  const PointCloud cloud = scan_street({.plates = {}, .kerb = 4, .step = 0.12}, 2);
  const auto before = find_curbs(cloud), after = find_curbs(shuffled(cloud, 3));
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].centre, after[i].centre);
    EXPECT_EQ(before[i].normal, after[i].normal);
    EXPECT_EQ(before[i].step, after[i].step);
  }
}

TEST(CloudCurbs, TurnAndMirrorWithTheScan) {
  const PointCloud cloud = scan_street({.plates = {}, .kerb = 4, .step = 0.12}, 4);
  for (const bool mirrored : {false, true})
    for (const double angle : {0.5, 1.3, -2.5}) {
      const auto curbs = find_curbs(turned(cloud, angle, mirrored));
      ASSERT_EQ(curbs.size(), 1U) << angle;
      const Eigen::Vector2d normal = turned(Eigen::Vector2d(0, -1), angle, mirrored);
      EXPECT_GT(curbs[0].normal.dot(normal), std::cos(0.02));
      EXPECT_NEAR(curbs[0].normal.dot(curbs[0].centre), -4, 0.06);
    }
}

TEST(CloudCurbs, WallsRampsAndNothingAreNone) {
  for (const PointCloud& cloud : bad_clouds()) EXPECT_TRUE(find_curbs(cloud).empty());
  EXPECT_TRUE(find_curbs(scan_street({.plates = {{{-20, 4}, {20, 4}, 0, 3}}}, 1)).empty());
  EXPECT_TRUE(find_curbs(scan_street({.plates = {}, .kerb = 4, .step = 0.5}, 1)).empty()) << "a platform";
}

TEST(CloudCurbs, TheDetectorGivesLines) {
  TypeRegistry types;
  register_landmark_types(types);
  const TypeId curb = types.id("curb");
  const auto seen =
      make_point_detector(types, std::vector{curb})(scan_street({.plates = {}, .kerb = 4, .step = 0.12}, 1));
  ASSERT_EQ(seen.sightings.size(), 1U);
  EXPECT_TRUE(seen.sightings[0].is_valid());
  EXPECT_TRUE(seen.sightings[0].extent);
  EXPECT_NEAR(*seen.sightings[0].range, 4, 0.06);
  EXPECT_NEAR(seen.sightings[0].features.value[feature_index(types[curb], "height")], 0.12, 0.02);
}

}  // namespace
}  // namespace waymark::test
