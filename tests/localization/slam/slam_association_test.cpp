// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/slam_association.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "core/random.hpp"

namespace waymark::test {
using namespace localization;
namespace {

/// Slow twin: takes the least pair again and again and strikes its row and its column.
std::vector<SlamPair> pair_by_striking_out(std::vector<SlamPair> pairs) {
  std::vector<SlamPair> chosen;
  while (!pairs.empty()) {
    const SlamPair least = *std::ranges::min_element(
        pairs, {}, [](const SlamPair& p) { return std::tie(p.squares, p.sighting, p.landmark); });
    chosen.push_back(least);
    std::erase_if(pairs, [&](const SlamPair& p) {
      return p.sighting == least.sighting || p.landmark == least.landmark;
    });
  }
  return chosen;
}

TEST(SlamPairing, IsThatOfTheSlowTwinInAnyOrder) {
  Random random(1, "pairs");
  const auto pick = [&](double below) { return static_cast<std::size_t>(random.uniform(0, below)); };
  for (int round = 0; round < 200; ++round) {
    std::vector<SlamPair> pairs;
    for (std::size_t n = pick(30); n > 0; --n)
      pairs.push_back({static_cast<double>(pick(5)), pick(6), pick(8)});
    const std::vector<SlamPair> expected = pair_by_striking_out(pairs);
    std::ranges::reverse(pairs);
    const std::vector<SlamPair> chosen = pair_one_to_one(pairs);
    ASSERT_EQ(chosen.size(), expected.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      EXPECT_EQ(chosen[i].sighting, expected[i].sighting);
      EXPECT_EQ(chosen[i].landmark, expected[i].landmark);
    }
  }
}

SlamCandidate candidate(std::size_t landmark, const Eigen::Vector2d& at) {
  return {landmark, true, expect({}, {}, at), 1e-4 * Eigen::Matrix2d::Identity()};
}

SeenLandmark sighting(double range, double bearing) {
  SeenLandmark s;
  s.range = range, s.bearing = bearing;
  s.range_sd = 0.1, s.bearing_sd = 0.01;
  return s;
}

TEST(SlamComparison, PairsALandmarkOfTheMapOnlyWithTheSightingIdentifiedAsIt) {
  std::vector<SlamLandmark> landmarks(2);
  landmarks[0].at = {10, 0}, landmarks[0].was_mapped = true, landmarks[0].key = 7;
  landmarks[1].at = {10, 0.3};
  const std::vector<SlamCandidate> candidates{candidate(0, landmarks[0].at), candidate(1, landmarks[1].at)};
  const std::vector<SeenLandmark> seen{sighting(10, 0)};
  const std::vector<std::optional<LandmarkKey>> unknown{std::nullopt}, known{7};

  const SlamPairs without = compare_with_landmarks(seen, candidates, landmarks, unknown, {}, {});
  ASSERT_EQ(without.pairs.size(), 1U);
  EXPECT_EQ(without.pairs[0].landmark, 1U);
  EXPECT_NEAR(without.comparisons[0].min_squares, 0,
              1e-12);  // it is near all the same, so nothing new starts
  const SlamPairs with = compare_with_landmarks(seen, candidates, landmarks, known, {}, {});
  EXPECT_EQ(with.pairs.size(), 2U);
  EXPECT_EQ(pair_one_to_one(with.pairs).at(0).landmark, 0U);
}

TEST(SlamComparison, AnIdentityIsComparedWithItsOwnLandmarkOnly) {
  std::vector<SlamLandmark> landmarks(2);
  landmarks[0].at = {10, 0}, landmarks[0].key = 7;
  landmarks[1].at = {10, 0.2}, landmarks[1].key = 8;
  const std::vector<SlamCandidate> candidates{candidate(0, landmarks[0].at), candidate(1, landmarks[1].at)};
  SlamOptions options;
  options.identification.use_identities = true;
  std::vector<SeenLandmark> seen{sighting(10, 0)};
  seen[0].identity = 8;
  const std::vector<std::optional<LandmarkKey>> in_map(1);
  const SlamPairs found = compare_with_landmarks(seen, candidates, landmarks, in_map, {}, options);
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_EQ(found.pairs[0].landmark, 1U);
  EXPECT_EQ(found.comparisons[0].min_distance, 0);

  seen[0].range = 60;  // farther than landmarks are seen
  EXPECT_FALSE(is_usable(seen[0], options));
  seen[0].bearing.reset();  // a beacon is heard
  EXPECT_TRUE(is_usable(seen[0], options));
}

/// Three landmarks seen 0.5 m too near as an error of the pose would show them, and one seen too far.
TEST(SlamCompatibility, RemovesThePairThatDisagreesWithTheOthers) {
  PoseEstimate start;
  start.covariance = Eigen::Vector3d(1, 1e-4, 1e-6).asDiagonal();
  SlamState state(start);
  std::vector<SeenLandmark> seen;
  std::vector<SlamPair> pairs;
  std::vector<SlamState::Correction> corrections;
  const double offsets[] = {-0.5, -0.5, 0.9, -0.5};
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d at(10, 0.5 * static_cast<double>(k));
    const ExpectedSighting e = expect({}, {}, at);
    seen.push_back(sighting(e.value[0] + offsets[k], e.value[1]));
    pairs.push_back({1, k, k});
    corrections.push_back({.slot = state.add(at, Eigen::Matrix2d(1e-4 * Eigen::Matrix2d::Identity())),
                           .innovation = innovation(seen[k], e.value),
                           .by_pose = e.by_pose,
                           .by_landmark = e.by_landmark,
                           .noise = sensor_noise(seen[k])});
  }
  remove_incompatible(state, seen, pairs, corrections);
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_TRUE(std::ranges::none_of(pairs, [](const SlamPair& p) { return p.sighting == 2; }));
  EXPECT_EQ(corrections.size(), 3U);
}

}  // namespace
}  // namespace waymark::test
