// SPDX-License-Identifier: Apache-2.0
#include "localization/independent_fraction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace waymark::test {
namespace {

using namespace localization;

struct Survey {
  double common_sd, independent_sd;  // m, of the landmarks' errors
  double noise_factor = 1;           // on the sensor's stated noise of 0.05 m and 0.005 rad
};

/// Returns the fraction after a straight drive past 60 landmarks with a stated deviation of 0.5 m. Each is
/// seen ten times.
double fraction_after_drive(const Survey& survey, std::uint64_t seed, bool has_range = true) {
  Random random(seed, "survey");
  const Eigen::Vector2d shift = survey.common_sd * Eigen::Vector2d(random.normal(), random.normal());
  IndependentFraction fraction;
  for (LandmarkKey key = 0; key < 60; key += 2) {
    SightingSet seen;
    std::vector<Match> matches;
    const Pose2 robot{2.0 * static_cast<double>(key), 0, 0};
    for (const double side : {-6.0, 6.0}) {
      const Eigen::Vector2d at(robot.x + random.uniform(2, 12), side);
      Match match;
      match.verdict = Verdict::matched, match.key = key + (side > 0);
      match.at = at + shift + survey.independent_sd * Eigen::Vector2d(random.normal(), random.normal());
      match.covariance = 0.25 * Eigen::Matrix2d::Identity();
      const Eigen::Vector2d relative = at - robot.at();
      SeenLandmark sighting;
      sighting.range_sd = 0.05, sighting.bearing_sd = 0.005;
      if (has_range) sighting.range = relative.norm() + survey.noise_factor * random.normal(0, 0.05);
      sighting.bearing =
          std::atan2(relative.y(), relative.x()) + survey.noise_factor * random.normal(0, 0.005);
      seen.sightings.push_back(sighting), matches.push_back(match);
    }
    // The localizer follows the shift, which its landmarks share.
    const PoseEstimate before{{robot.x + shift.x(), robot.y + shift.y(), robot.yaw},
                              Eigen::Vector3d(0.02, 0.02, 1e-4).asDiagonal()};
    for (int i = 0; i < 10; ++i) fraction.learn(seen, matches, before);
  }
  return fraction.mean();
}

TEST(IndependentFraction, LandmarksThatDifferAreIndependent) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    EXPECT_GT(fraction_after_drive({0, 0.5}, seed), 0.75) << seed;
}

TEST(IndependentFraction, LandmarksThatAgreeShareTheirError) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    EXPECT_LT(fraction_after_drive({0.5, 0}, seed), 0.1) << seed;
}

// 120 innovations: the variance is known to an eighth, so the fraction to 0.2 (two standard deviations, with
// the prior).
TEST(IndependentFraction, IsThatOfTheVariance) {
  const double sd = 0.5 * std::sqrt(0.5);
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    EXPECT_NEAR(fraction_after_drive({sd, sd}, seed), 0.5, 0.25);
}

TEST(IndependentFraction, NoiseAboveTheStatedOneIsNoErrorOfTheMap) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    EXPECT_LT(fraction_after_drive({0.5, 0, 1.5}, seed), 0.1) << seed;
}

TEST(IndependentFraction, BearingsAloneTeachNothing) {
  EXPECT_NEAR(fraction_after_drive({0, 0.5}, 1, false), 0.5, 1e-12);
}

}  // namespace
}  // namespace waymark::test
