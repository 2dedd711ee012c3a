// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_facades.hpp"

#include <gmock/gmock.h>

#include "localization/detectors/scan_landmarks.hpp"
#include "tests/localization/made_street.hpp"

namespace waymark::test {
using namespace localization;
namespace {

/// Two facades, one of them turned, and a row of cars.
MadeStreet two_facades() {
  return {.plates = {{{-8, 9}, {7, 9}, 0, 8},
                     {{-3, -9}, {9, -11}, 0, 6},
                     {{3, 5}, {7.4, 5}, 0.15, 1.5},
                     {{-6, 5}, {-1.6, 5}, 0.15, 1.5},
                     {{12, -5}, {17, -5}, 0.15, 2.3}}};
}

const CloudFacade* nearest_facade(const std::vector<CloudFacade>& all, const Eigen::Vector2d& at) {
  const auto found = std::ranges::min_element(all, {}, [&](const CloudFacade& f) {
    return std::abs(f.normal.dot(at - f.centre)) + (f.centre - at).norm();
  });
  return found == all.end() ? nullptr : &*found;
}

TEST(CloudFacades, AreFoundWhereTheyStandAndNoCars) {
  const auto facades = find_facades(scan_street(two_facades(), 1));
  ASSERT_EQ(facades.size(), 2U);
  const CloudFacade& north = *nearest_facade(facades, {0, 9});
  EXPECT_NEAR(north.normal.y(), -1, 1e-4);
  EXPECT_NEAR(north.centre.y(), 9, 0.02);
  EXPECT_NEAR(north.centre.x() + north.begin, -8, 0.3) << "to the left of the normal is east";
  EXPECT_NEAR(north.centre.x() + north.end, 7, 0.3);
  const CloudFacade& south = *nearest_facade(facades, {3, -10});
  const Eigen::Vector2d normal = Eigen::Vector2d(2, 12).normalized();
  EXPECT_NEAR(std::acos(south.normal.dot(normal)), 0, 0.01);
  EXPECT_NEAR(normal.dot(south.centre - Eigen::Vector2d(-3, -9)), 0, 0.02);
  EXPECT_LT(south.centre_variance, 0.03 * 0.03);
}

// Over many scans the errors are those that are stated.
TEST(CloudFacades, ErrAsTheyState) {
  double squares = 0, angle_squares = 0;
  constexpr int kScans = 12;
  for (unsigned seed = 0; seed < kScans; ++seed) {
    const auto facades = find_facades(scan_street({.plates = {{{-8, 9}, {7, 9}, 0, 8}}}, seed));
    ASSERT_EQ(facades.size(), 1U) << "seed " << seed;
    squares += std::pow(facades[0].centre.y() - 9, 2) / facades[0].centre_variance;
    angle_squares += std::pow(facades[0].normal.x(), 2) / facades[0].angle_variance;
  }
  EXPECT_LT(squares / kScans, 1.5);  // the stated variances include walls that are not flat
  EXPECT_LT(angle_squares / kScans, 1.5);
}

TEST(CloudFacades, AreIndependentOfTheOrderOfPoints) {
  const PointCloud cloud = scan_street(two_facades(), 2);
  const auto before = find_facades(cloud), after = find_facades(shuffled(cloud, 5));
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].centre, after[i].centre);
    EXPECT_EQ(before[i].normal, after[i].normal);
    EXPECT_EQ(before[i].end, after[i].end);
    EXPECT_EQ(before[i].centre_variance, after[i].centre_variance);
  }
}

TEST(CloudFacades, TurnAndMirrorWithTheScan) {
  const PointCloud cloud = scan_street(two_facades(), 3);
  const auto before = find_facades(cloud);
  for (const bool mirrored : {false, true})
    for (const double angle : {0.3, 1.1, 2.9}) {
      const auto after = find_facades(turned(cloud, angle, mirrored));
      ASSERT_EQ(before.size(), after.size()) << angle;
      for (const CloudFacade& f : before) {
        const Eigen::Vector2d at = turned(f.centre, angle, mirrored),
                              normal = turned(f.normal, angle, mirrored);
        const CloudFacade& same = *nearest_facade(after, at);
        EXPECT_NEAR(normal.dot(same.normal), 1, 1e-4);
        EXPECT_NEAR(normal.dot(same.centre - at), 0, 0.02);
        EXPECT_NEAR(same.length(), f.length(), 0.5);
      }
    }
}

TEST(CloudFacades, NothingIsFoundInNothingAndInHedges) {
  for (const PointCloud& cloud : bad_clouds()) EXPECT_TRUE(find_facades(cloud).empty());
  EXPECT_TRUE(find_facades(scan_street({.plates = {{{-8, 9}, {7, 9}, 0, 4}, {{-8, -6}, {7, -7}, 0, 3}},
                                        .hedge_depth = 0.5},
                                       1))
                  .empty());
}

TEST(CloudFacades, TheDetectorGivesLinesWithAnExtent) {
  TypeRegistry types;
  register_landmark_types(types);
  const TypeId wall = types.id("wall");
  const auto seen =
      make_point_detector(types, std::vector{wall})(scan_street({.plates = {{{-8, 9}, {4, 9}, 0, 8}}}, 1));
  ASSERT_EQ(seen.sightings.size(), 1U);
  const SeenLandmark& s = seen.sightings[0];
  EXPECT_TRUE(s.is_valid());
  EXPECT_EQ(s.type, wall);
  EXPECT_FALSE(s.bearing);
  EXPECT_NEAR(*s.range, 9, 0.03);
  EXPECT_NEAR(s.extent->from, -8, 0.3);
  EXPECT_NEAR(s.extent->to, 4, 0.3);
  EXPECT_NEAR(s.features.value[feature_index(types[wall], "direction")], -std::numbers::pi / 2, 0.02);
  EXPECT_LT(s.range_sd, 0.05);
}

}  // namespace
}  // namespace waymark::test
