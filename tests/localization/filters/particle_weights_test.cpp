// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/sighting_score.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "localization/chi_square.hpp"
#include "localization/filters/resampling.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

TEST(Paper, WeightsOfEquation14) {
  EXPECT_EQ(paper_weights(std::vector<double>{0, 5, 10}), (std::vector<double>{1, 0.5, 0}));
  const std::vector<double> same{1, 1, 1};
  EXPECT_EQ(paper_weights(std::vector<double>{0, 0, 0}), same) << "e_max = 0";
  EXPECT_EQ(paper_weights(std::vector<double>{7, 7, 7}), same) << "all equal: 0 for each by the letter";
  EXPECT_EQ(paper_weights(std::vector<double>{7}), std::vector<double>{1}) << "a single particle";
}

// By the letter of eqs. 12-14 a particle that matches nothing has error 0, the best there is.
TEST(Paper, UnmatchedSightingsCostTheGate) {
  const LandmarkGrid map({landmark_at(10, 0, 1)});
  const FeatureScales scales;
  WeightOptions options;
  options.weights = "paper";
  const SightingSet seen{{}, {seen_at(10, 0)}};
  const Pose2 near{0.1, 0, 0}, nowhere{100, 0, 0};
  const SightingScore sound(seen, map, scales, options, {});
  EXPECT_LT(sound(near), sound(nowhere));
  options.unmatched_cost = 0;
  const SightingScore letter(seen, map, scales, options, {});
  EXPECT_GT(letter(near), letter(nowhere));
}

// Eq. 10 takes the minimum of the distances alone; its landmark's quality enters eq. 12 afterwards. The
// landmark at 2 standard deviations (distance 4) has a product of 0.4, that at 1 (distance 1) one of 0.8.
TEST(Paper, MatchIsTheLeastDistanceBeforeQualityWeighsIt) {
  MapLandmark doubtful = landmark_at(10.2, 0, 1), sure = landmark_at(9.9, 0, 2);
  doubtful.quality = 0.1, sure.quality = 0.8;
  const LandmarkGrid map({doubtful, sure});
  const FeatureScales scales;
  WeightOptions options;
  options.weights = "paper";
  const SightingSet one{{}, {seen_at(10, 0)}}, two{{}, {seen_at(10, 0), seen_at(10.2, 0.02)}};
  EXPECT_NEAR(SightingScore(one, map, scales, options, {.use_identities = false})(Pose2{}), 1 * 0.8, 1e-9);
  // The second sighting is at the doubtful landmark but for one standard deviation of the bearing.
  EXPECT_NEAR(SightingScore(two, map, scales, options, {.use_identities = false})(Pose2{}), 1 * 0.8 + 1 * 0.1,
              1e-9);
  // q by the letter is eq. 8, which `quality=paper` selects; no floor raises it, and 1 switches it off.
  MapLandmark vague = sure, blurred = doubtful;
  vague.paper_quality = 0.3, blurred.paper_quality = 0.05;
  const LandmarkGrid valued({blurred, vague});
  IdentificationOptions by_letter{.use_identities = false};
  by_letter.quality = "paper";
  EXPECT_NEAR(SightingScore(two, valued, scales, options, by_letter)(Pose2{}), 1 * 0.3 + 1 * 0.05, 1e-9);
  by_letter.quality_floor = 1;
  EXPECT_NEAR(SightingScore(two, valued, scales, options, by_letter)(Pose2{}), 1 + 1, 1e-9);
}

TEST(SightingScore, IsTheDensityOfTheNearestLandmark) {
  Random random(3);
  const auto all = scatter_landmarks(40, 20, 2, 0.1);
  const LandmarkGrid map(all);
  const FeatureScales scales;
  WeightOptions options;
  options.temper = 1;
  const SightingSet seen{{0.3, 0.1, 0.2}, {seen_at(4, 0.3), seen_at(6, -0.8)}};
  const SightingScore score(seen, map, scales, options, {});
  for (int i = 0; i < 200; ++i) {
    const Pose2 robot{random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-3, 3)};
    double expected = 0;
    for (const SeenLandmark& s : seen.sightings) {
      double best = 0;
      for (const MapLandmark& l : all) {
        const auto e = evidence_of(s, expect(robot, seen.robot_from_sensor, l.at), l.covariance);
        if (e.squares > chi_square_quantile(options.gate, 2)) continue;
        best = std::max(best, std::exp(-(e.squares + e.log_det) / 2) / (2 * std::numbers::pi));
      }
      expected += std::log(IdentificationOptions{}.clutter + best);
    }
    ASSERT_NEAR(score(robot), expected, 2e-3 * std::max(1.0, std::abs(expected)));
  }
}

// Neither shared candidates nor their bounds may change any score, not even in its last bit; also where
// landmarks are known to a centimetre in one direction and to metres in the other.
TEST(SightingScore, PrefetchingChangesNoScore) {
  std::size_t fits = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Random random(seed, "cloud");
    auto all = scatter_landmarks(400, 60, seed, 0.1);
    for (MapLandmark& l : all) {
      l.type = static_cast<TypeId>(random.uniform_index(2));
      l.quality = random.uniform(0.1, 1);
      l.features.value[0] = random.uniform(0.5, 1);
      if (seed % 2) continue;
      const double long_sd = random.log_uniform(0.01, 3), short_sd = random.log_uniform(0.01, long_sd);
      const Eigen::Rotation2Dd turn(random.uniform(0, 3.2));
      l.covariance = turn * Eigen::Vector2d(long_sd * long_sd, short_sd * short_sd).asDiagonal() *
                     turn.toRotationMatrix().transpose();
    }
    const LandmarkGrid map(all);
    const FeatureScales scales;
    WeightOptions options;
    options.weights = seed % 5 == 0 ? "paper" : "likelihood";
    options.expect_unseen = seed % 3 == 0;
    SightingSet seen{{0.3, 0.1, random.uniform(-3, 3)}, {}};
    for (int i = 0; i < 6; ++i) {
      seen.sightings.push_back(seen_at(random.uniform(1, 20), random.uniform(-3, 3)));
      SeenLandmark& s = seen.sightings.back();
      if (random.bernoulli(0.3)) s.range.reset();
      if (random.bernoulli(0.7)) s.type = TypeId{0}, s.features.value[0] = 0.7, s.features.variance[0] = 0.01;
      if (random.bernoulli(0.2)) s.identity = random.uniform_index(450);
    }
    SightingScore score(seen, map, scales, options, {.bearing_reach = 40}, [&](LandmarkKey key) {
      return seed % 4 == 2 ? 1 + static_cast<double>(key % 5) : 1;
    });
    const double wide = seed % 4 == 0 ? 20 : 0.5, turned = seed % 7 == 0 ? 3 : 0.1;
    const Pose2 middle{random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-3.1, 3.1)};
    std::vector<Pose2> poses;
    for (int i = 0; i < 200; ++i)
      poses.push_back(middle *
                      Pose2{wide * random.normal(), wide * random.normal(), turned * random.normal()});
    std::vector<double> before;
    for (const Pose2& p : poses) before.push_back(score(p));
    score.prefetch(std::span(poses).first(150));  // the others are as ever
    for (std::size_t i = 0; i < poses.size(); ++i) {
      ASSERT_EQ(score(poses[i]), before[i]) << "seed " << seed << " pose " << i;
      fits += before[i] != before[0];
    }
    std::vector<double> several(poses.size());
    score(std::span(poses).first(150), several);  // but for rounding
    score(std::span(poses).subspan(150), std::span(several).subspan(150));
    for (std::size_t i = 0; i < poses.size(); ++i)
      ASSERT_NEAR(several[i], before[i], 1e-9 * std::abs(before[i])) << "seed " << seed << " pose " << i;
  }
  EXPECT_GT(fits, 1000u);
}

TEST(Resampling, DrawsEachWithinOneOfItsExpectedNumber) {
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    std::vector<double> logs(50);
    for (double& w : logs) w = random.uniform(-5, 0);
    const auto weights = normalise_log_weights(logs);
    std::vector<int> count(50, 0);
    for (const auto k : resample(weights, 200, random.uniform())) ++count[k];
    for (std::size_t k = 0; k < 50; ++k) EXPECT_LT(std::abs(count[k] - 200 * weights[k]), 1 + 1e-9);
  }
}

TEST(Resampling, HopelessWeightsBecomeEqual) {
  const double none = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(normalise_log_weights(std::vector<double>{none, none}), (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(normalise_log_weights(std::vector<double>{-1e6, none}), (std::vector<double>{1, 0}))
      << "no underflow";
}

TEST(Resampling, KldCountOfFox) {
  EXPECT_EQ(kld_count(1, 0.05), 1u);
  EXPECT_NEAR(static_cast<double>(kld_count(100, 0.05)), 1349, 6);  // chi2(0.99, 99) = 134.64 over 2 x 0.05
}

}  // namespace
}  // namespace waymark::test
