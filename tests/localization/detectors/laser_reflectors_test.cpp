// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/laser_reflectors.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.hpp"
#include "localization/detectors/scan_landmarks.hpp"

namespace waymark::test {
using namespace localization;
namespace {

struct ReflectingPost {
  double x, y, radius;
  float intensity;
};

/// A scan over half a turn of posts before a wall along y = `wall`, whose glare is strongest head-on.
LaserScan scan_posts(const std::vector<ReflectingPost>& posts, double wall, std::uint64_t seed,
                     double glare = 0) {
  Random random(seed);
  LaserScan scan{.robot_from_sensor = {},
                 .first_angle = 0,
                 .angle_step = std::numbers::pi / 720,
                 .ranges = {},
                 .max_range = 40};
  for (int i = 0; i <= 720; ++i) {
    const double angle = i * scan.angle_step, dx = std::cos(angle), dy = std::sin(angle);
    double range = dy > 1e-6 ? wall / dy : 1e9;
    const double off = std::acos(std::min(1.0, dy)) / 0.05;
    double intensity = 0.3 * dy + glare * std::exp(-off * off);
    for (const ReflectingPost& p : posts) {
      const double middle = p.x * dx + p.y * dy, aside = dx * p.y - dy * p.x;
      if (std::abs(aside) >= p.radius || middle <= 0) continue;
      const double hit = middle - std::sqrt(p.radius * p.radius - aside * aside);
      if (hit < range) range = hit, intensity = static_cast<double>(p.intensity);
    }
    scan.ranges.push_back(range < 40 ? static_cast<float>(range + random.normal(0, 0.01)) : 0.0F);
    scan.intensities.push_back(static_cast<float>(std::max(0.0, intensity + random.normal(0, 0.01))));
  }
  return scan;
}

TEST(LaserReflectors, AreFoundAmongDullPosts) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<ReflectingPost> posts{
        {3, 4, 0.05, 1}, {-5, 6, 0.04, 1}, {1, 5, 0.05, 0.3F}, {6, 3, 0.1, 0.35F}};
    for (const Reflector& r : find_reflectors(scan_posts(posts, 12, seed))) {
      const Eigen::Vector2d at(r.range * std::cos(r.bearing), r.range * std::sin(r.bearing));
      const double off = std::min((at - Eigen::Vector2d(3, 4)).norm(), (at - Eigen::Vector2d(-5, 6)).norm());
      EXPECT_LT(off, 0.04) << "seed " << seed;
      EXPECT_LT(off, 3 * std::hypot(r.range_sd, r.range * r.bearing_sd));
      ++found;
    }
  }
  EXPECT_EQ(found, 40);
}

TEST(LaserReflectors, ABrightWallIsNone) {
  for (const double wall : {0.5, 1.0, 2.0, 5.0, 15.0})
    EXPECT_TRUE(find_reflectors(scan_posts({}, wall, 1, 1)).empty()) << wall;
  // Nor does it hide the posts before it.
  EXPECT_EQ(find_reflectors(scan_posts({{3, 4, 0.05, 1}}, 8, 1, 0.8)).size(), 1U);
}

TEST(LaserReflectors, BeamsInEitherOrderGiveTheSame) {
  LaserScan scan = scan_posts({{3, 4, 0.05, 1}, {-5, 6, 0.04, 1}}, 12, 3);
  const auto before = find_reflectors(scan);
  std::ranges::reverse(scan.ranges);
  std::ranges::reverse(scan.intensities);  // mirrored left and right
  const auto after = find_reflectors(scan);
  ASSERT_EQ(before.size(), 2U);
  ASSERT_EQ(after.size(), 2U);
  EXPECT_NEAR(after[1].bearing, std::numbers::pi - before[0].bearing, 1e-6);
  EXPECT_NEAR(after[1].range, before[0].range, 1e-6);
}

TEST(LaserReflectors, NothingIsFoundInNothing) {
  EXPECT_TRUE(find_reflectors({}).empty());
  LaserScan scan = scan_posts({{3, 4, 0.05, 1}}, 12, 1);
  scan.intensities.clear();
  EXPECT_TRUE(find_reflectors(scan).empty());
  scan = scan_posts({{3, 4, 0.05, 1}}, 12, 1);
  std::ranges::fill(scan.ranges, 0.0F);
  EXPECT_TRUE(find_reflectors(scan).empty());
  scan = scan_posts({{3, 4, 0.05, 1}}, 12, 1);
  std::ranges::fill(scan.intensities, std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(find_reflectors(scan).empty());
  std::ranges::fill(scan.intensities, 0.0F);
  EXPECT_TRUE(find_reflectors(scan).empty());
}

TEST(LaserReflectors, AreBeaconsOfNoIdentity) {
  TypeRegistry types;
  register_landmark_types(types);
  const TypeId beacon = types.id("beacon"), pole = types.id("pole");
  LaserScan scan = scan_posts({{3, 4, 0.05, 1}, {-5, 6, 0.08, 0.3F}}, 12, 1);
  const auto seen = make_laser_detector(types, {}, std::vector{beacon})(scan).sightings;
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].type, beacon);
  EXPECT_FALSE(seen[0].identity);
  EXPECT_NEAR(*seen[0].range, 5, 0.04);
  // In a map of both it is one object, a beacon or a pole.
  const auto both = make_laser_detector(types, {}, std::vector{beacon, pole})(scan).sightings;
  ASSERT_EQ(both.size(), 2U);
  EXPECT_TRUE(std::ranges::any_of(both, [&](auto& s) { return s.may_be(beacon) && s.may_be(pole); }));
  // Logs without intensities are read as before.
  scan.intensities.clear();
  EXPECT_EQ(make_laser_detector(types, {}, std::vector{beacon})(scan).sightings.size(), 2U);
  EXPECT_EQ(make_laser_detector(types, {.find = "reflectors"}, {})(scan).sightings.size(), 0U);
}

}  // namespace
}  // namespace waymark::test
