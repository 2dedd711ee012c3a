// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_signs.hpp"

#include <gmock/gmock.h>

#include "localization/detectors/scan_landmarks.hpp"
#include "tests/localization/made_street.hpp"

namespace waymark::test {
using namespace localization;
namespace {

/// Two signs and a bright wall, which is seen head-on.
MadeStreet signs_and_wall() {
  return {.plates = {{{10.1, 3.8}, {9.9, 4.4}, 1.7, 2.3, 0.95F},
                     {{-8, -5.3}, {-8, -4.7}, 1.6, 2.2, 0.95F},
                     {{-6, 9}, {6, 9}, 0, 4, 0.45F}}};
}
const Eigen::Vector2d kSigns[] = {{10, 4.1}, {-8, -5}};

/// Without intensities plates must be free, and not near the upper rows only.
PointCloud without_intensities(PointCloud cloud) {
  cloud.intensities.clear();
  return cloud;
}

TEST(CloudSigns, AreFoundByIntensityAndByShape) {
  const PointCloud cloud = scan_street(signs_and_wall(), 1, 10);
  for (const auto& signs : {find_signs(cloud), find_signs(without_intensities(cloud))}) {
    ASSERT_EQ(signs.size(), 2U);
    for (const Eigen::Vector2d& at : kSigns) {
      const auto sign = std::ranges::find_if(signs, [&](auto& s) { return (s.at - at).norm() < 0.2; });
      ASSERT_NE(sign, signs.end()) << at.transpose();
      EXPECT_LT((sign->at - at).norm(), 0.08);
      EXPECT_NEAR(sign->height, at.x() > 0 ? 2 : 1.9, 0.15);
      const Eigen::Vector2d normal =
          at.x() > 0 ? Eigen::Vector2d(-0.6, -0.2).normalized() : Eigen::Vector2d(1, 0);
      EXPECT_GT(sign->normal.dot(normal), std::cos(0.2)) << sign->normal.transpose();
    }
  }
}

TEST(CloudSigns, IntensitiesThatAreAllAlikeAreNone) {
  const PointCloud plain = without_intensities(scan_street(signs_and_wall(), 1, 10));
  for (const float intensity : {0.0F, 255.0F}) {
    PointCloud alike = plain;
    alike.intensities.assign(alike.points.size(), intensity);
    const auto signs = find_signs(alike), expected = find_signs(plain);
    ASSERT_EQ(signs.size(), expected.size()) << intensity;
    for (std::size_t i = 0; i < signs.size(); ++i) EXPECT_EQ(signs[i].at, expected[i].at);
  }
}

TEST(CloudSigns, AreFoundInUnitsOfAnyScanner) {
  PointCloud cloud = scan_street(signs_and_wall(), 2, 10);
  for (float& intensity : cloud.intensities) intensity *= 255;
  EXPECT_EQ(find_signs(cloud).size(), 2U);
}

TEST(CloudSigns, AreIndependentOfTheOrderOfPoints) {
  const PointCloud cloud = scan_street(signs_and_wall(), 3, 10);
  for (const PointCloud& scan : {cloud, without_intensities(cloud)}) {
    const auto before = find_signs(scan), after = find_signs(shuffled(scan, 7));
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(before[i].at, after[i].at);
      EXPECT_EQ(before[i].normal, after[i].normal);
      EXPECT_EQ(before[i].height, after[i].height);
    }
  }
}

TEST(CloudSigns, TurnAndMirrorWithTheScan) {
  const PointCloud cloud = scan_street(signs_and_wall(), 4, 10);
  for (const bool mirrored : {false, true})
    for (const double angle : {0.4, 2.2}) {
      const auto signs = find_signs(turned(cloud, angle, mirrored));
      EXPECT_EQ(signs.size(), 2U);
      for (const Eigen::Vector2d& at : kSigns)
        EXPECT_TRUE(std::ranges::any_of(
            signs, [&](auto& s) { return (s.at - turned(at, angle, mirrored)).norm() < 0.08; }));
    }
}

TEST(CloudSigns, BrightWallsBillboardsAndNothingAreNone) {
  for (const PointCloud& cloud : bad_clouds()) EXPECT_TRUE(find_signs(cloud).empty());
  const MadeStreet wall{.plates = {{{-6, 5}, {6, 5}, 0, 4, 0.5F}}};
  const MadeStreet board{.plates = {{{5, 6}, {8, 6}, 1.5, 4, 0.95F}}};    // too large
  const MadeStreet low{.plates = {{{5, 6}, {5.5, 6}, 0.4, 0.6, 0.95F}}};  // a number plate
  for (const MadeStreet& street : {wall, board, low}) {
    EXPECT_TRUE(find_signs(scan_street(street, 1, 10)).empty());
    EXPECT_TRUE(find_signs(without_intensities(scan_street(street, 1, 10))).empty());
  }
}

TEST(CloudSigns, TheDetectorGivesFacingAndHeight) {
  TypeRegistry types;
  register_landmark_types(types);
  const TypeId sign = types.id("traffic_sign");
  const auto seen = make_point_detector(types, std::vector{sign})(
      scan_street({.plates = {{{8, -0.3}, {8, 0.3}, 1.7, 2.3, 0.9F}, {{-6, 9}, {6, 9}, 0, 4}}}, 1, 10));
  ASSERT_EQ(seen.sightings.size(), 1U);
  const SeenLandmark& s = seen.sightings[0];
  EXPECT_TRUE(s.is_valid());
  EXPECT_NEAR(*s.range, 8, 0.05);
  EXPECT_NEAR(*s.bearing, 0, 0.01);
  EXPECT_NEAR(std::abs(s.features.value[feature_index(types[sign], "facing")]), std::numbers::pi, 0.2);
  EXPECT_NEAR(s.features.value[feature_index(types[sign], "height")], 2, 0.15);
}

}  // namespace
}  // namespace waymark::test
