// SPDX-License-Identifier: Apache-2.0
// Sightings that fit by chance.
#include <gtest/gtest.h>

#include "localization/filters/convergence.hpp"
#include "tests/localization/made_world.hpp"
namespace waymark::test {
using namespace localization;
namespace {

TEST(ExplainedFraction, IsTheFractionOnTheMap) {
  // Of ten sightings the part q is on the map, the others fit with probability c.
  for (const double q : {0.0, 0.3, 0.8})
    for (const double c : {0.0, 0.4}) {
      ExplainedFraction explained;
      Random random(11, "explained");
      for (int set = 0; set < 400; ++set) {
        int fits = 0, by_chance = 0;
        for (int i = 0; i < 10; ++i) {
          fits += random.bernoulli(q) || random.bernoulli(c);
          by_chance += random.bernoulli(c);
        }
        explained.add(fits / 10.0, by_chance / 10.0);
        EXPECT_EQ(explained.known(), set >= 19);
      }
      EXPECT_NEAR(explained.value(), q, 0.1) << c;  // 400 sightings count: sd 0.04
    }
  ExplainedFraction nothing;
  for (int i = 0; i < 50; ++i) nothing.add(-1, 0.2);
  EXPECT_FALSE(nothing.known());
}

TEST(ExplainedFraction, ChanceGrowsWithTheDensityOfTheMap) {
  SightingSet seen;
  Random random(2, "seen");
  for (int i = 0; i < 12; ++i) {
    SeenLandmark s;
    s.range = random.uniform(3, 12), s.bearing = random.uniform(-1.5, 1.5);
    seen.sightings.push_back(s);
  }
  PoseEstimate at;
  at.covariance = Eigen::Vector3d(0.04, 0.04, 1e-3).asDiagonal();
  double before = -1;
  for (const std::size_t count : {0UL, 200UL, 2000UL}) {
    IdentificationOptions o;
    o.use_identities = false;
    ChanceFraction chance = make_chance_fraction(
        LandmarkMatcher(LandmarkWindow(LandmarkGrid(scatter_landmarks(count, 100, 5, 0.3))), {}, o));
    double sum = 0;
    for (int i = 0; i < 60; ++i) sum += chance(seen, at, {}) / 60;
    EXPECT_GT(sum, before) << count;
    before = sum;
  }
  EXPECT_GT(before, 0.1);
  EXPECT_LT(before, 0.9);
  // The same at each run; nothing without ranges.
  const LandmarkGrid grid(scatter_landmarks(800, 100, 5, 0.3));
  ChanceFraction one = make_chance_fraction(LandmarkMatcher(LandmarkWindow(grid))),
                 two = make_chance_fraction(LandmarkMatcher(LandmarkWindow(grid)));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(one(seen, at, {}), two(seen, at, {}));
  EXPECT_LT(one({}, at, {}), 0);
}

TEST(Convergence, CoversTheMapUntilItIsProven) {
  PoseEstimate prior;
  prior.covariance = Eigen::Vector3d(1600, 1600, 3.3).asDiagonal();
  Convergence c(prior, true);
  PoseEstimate gathered{{30, 0, 1}, Eigen::Matrix3d::Identity() * 0.01};
  EXPECT_NEAR(c.inflate_covariance(gathered).covariance(0, 0), 1600 + 900 + 0.01, 1e-9);
  EXPECT_NEAR(c.inflate_covariance(gathered).covariance(1, 1), 1600 + 0.01, 1e-9);
  for (int i = 0; i < 100; ++i) c.count(0.45, 0.4, true);  // as much as chance
  EXPECT_FALSE(c.found());
  for (int i = 0; i < 200; ++i) c.count(0.7, 0.4, true);
  EXPECT_TRUE(c.found());
  EXPECT_EQ(c.inflate_covariance(gathered).covariance, gathered.covariance);
  c.count(0.7, 0.4, false);  // two modes
  EXPECT_FALSE(c.found());
  // A fix from outside bounds it, however often it is said no better than its lasting errors.
  for (int i = 0; i < 10; ++i) c.fix({.at = {28, 1}, .sd = 3});
  EXPECT_NEAR(c.inflate_covariance(gathered).covariance(0, 0), 36 + 4 + 0.01, 1e-9);
  // A finder that is sure of this place proves it, of another disproves it.
  c.confirm(gathered, gathered);
  EXPECT_TRUE(c.found());
  c.confirm({{80, 0, 1}, gathered.covariance}, gathered);
  EXPECT_FALSE(c.found());
  c.confirm({{30, 0, -1}, gathered.covariance}, gathered);
  EXPECT_FALSE(c.found()) << "of another heading";
}

TEST(Convergence, RangesAloneAreNoProof) {
  Convergence c({}, true);
  for (int i = 0; i < 300; ++i) c.count(1, 0, true, false);
  EXPECT_FALSE(c.found());
  c.accept();
  for (int i = 0; i < 300; ++i) c.count(1, 0, true, false);
  EXPECT_TRUE(c.found());
}

// The filter chose where most fits, and a robot at rest sees the same chance again and again.
TEST(Convergence, FitsWithoutIdentitiesAreNoProofHoweverOftenTheyRepeat) {
  Convergence c({}, false);
  for (int i = 0; i < 1000; ++i) c.count(0.9, 0.4, true);
  EXPECT_FALSE(c.found());
  c.accept();
  EXPECT_TRUE(c.found());
  for (int i = 0; i < 1000; ++i) c.count(0.9, 0.4, true);
  EXPECT_TRUE(c.found());
  for (int i = 0; i < 1000; ++i) c.count(0.4, 0.4, true);  // as much as chance: carried elsewhere
  EXPECT_FALSE(c.found());
}

}  // namespace
}  // namespace waymark::test
