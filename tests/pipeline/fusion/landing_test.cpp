// SPDX-License-Identifier: Apache-2.0
// Truth tests on whole landings: detections with realistic errors, projected through erroneous poses and DEM.
// Seeds 1 to 4 were used to choose common_fraction and rim_shape; the seeds here were not.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "pipeline/fusion/association/alignment.hpp"
#include "tests/pipeline/fusion/made_landing.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

testbed::Scenario landing(std::int64_t seed, double position_sd, double attitude_sd, double rocks) {
  testbed::Scenario scenario;
  scenario.seed = seed;
  scenario.ground.width = scenario.ground.height = 0;
  scenario.ground.cell = 1;
  scenario.ground.rocks.k = rocks;
  scenario.lens.columns = scenario.lens.rows = 600;
  scenario.flights.front().images = 12;
  scenario.pose_errors = {position_sd, Degrees{attitude_sd}};
  return scenario;
}

TEST(Landing, EllipsesOfObservationsHoldNineInTen) {
  int inside = 0, all = 0;
  for (const std::int64_t seed : {11, 12}) {
    const MadeLanding made = made_landing(landing(seed, 0.3, 0.04, 0.05));
    for (std::size_t i = 0; i < made.observations.size(); ++i) {
      if (made.thing[i] < 0) continue;
      const Eigen::Vector2d error =
          made.observations[i].position.xyz.head<2>() - made.true_position(made.thing[i]);
      const Eigen::Matrix2d covariance = made.observations[i].covariance.topLeftCorner<2, 2>();
      inside += error.dot(covariance.inverse() * error) <= 4.605;
      ++all;
    }
  }
  RecordProperty("observations", all);
  EXPECT_GE(all, 1000);
  EXPECT_GE(inside, 0.85 * all);
  EXPECT_LE(inside, 0.95 * all);
}

TEST(Landing, AlignedImagesMergeWithoutMixingAndKeepHonest) {
  MergeScore sum;
  for (const std::int64_t seed : {11, 12, 13}) {
    MadeLanding made = made_landing(landing(seed, 0.6, 0.06, 0.12));
    const Alignment aligned =
        align_images(made.observations, made.images, made.dem, made.types, Crs::local());
    EXPECT_GT(aligned.pairs, 300);
    made.observations = aligned.observations;
    MergedObservations merged = merge_observations(made.observations, made.types, Crs::local());
    for (Landmark& l : merged.landmarks)
      l.covariance.topLeftCorner<2, 2>() += aligned.images[0].common_covariance;
    const MergeScore s = merge_score(made, merged);
    sum.landmarks += s.landmarks, sum.doubled += s.doubled, sum.mixed += s.mixed;
    sum.checked += s.checked, sum.inside += s.inside;
  }
  RecordProperty("landmarks", sum.landmarks);
  RecordProperty("doubled", sum.doubled);
  RecordProperty("mixed", sum.mixed);
  EXPECT_LE(sum.doubled, 0.01 * sum.landmarks);
  EXPECT_LE(sum.mixed, 0.01 * sum.landmarks);
  // All landmarks of a scene share the common error of its images, so few scenes cannot distinguish 85 from
  // 95 %.
  EXPECT_GE(sum.inside, 0.75 * sum.checked);
}

TEST(Landing, AlignmentIsWhatKeepsNeighboursApart) {
  MadeLanding made = made_landing(landing(14, 1.0, 0.1, 0.12));
  const auto mixed_share = [&] {
    const MergeScore s = merge_score(made, merge_observations(made.observations, made.types, Crs::local()));
    return static_cast<double>(s.mixed) / s.landmarks;
  };
  const double before = mixed_share();
  made.observations =
      align_images(made.observations, made.images, made.dem, made.types, Crs::local()).observations;
  EXPECT_GT(before, 0.03);
  EXPECT_LT(mixed_share(), 0.02);
}

TEST(Landing, ExactPosesDoNotMove) {
  const MadeLanding made = made_landing(landing(15, 0, 0, 0.05));
  const Alignment aligned = align_images(made.observations, made.images, made.dem, made.types, Crs::local());
  for (const double moved : aligned.shifts) EXPECT_EQ(moved, 0);
  EXPECT_EQ(aligned.images[0].common_covariance, Eigen::Matrix2d::Zero());
}

TEST(Landing, MergingDoesNotDependOnTheOrder) {
  const MadeLanding made = made_landing(landing(16, 0.3, 0.04, 0.05));
  const auto first = merge_observations(made.observations, made.types, Crs::local());
  auto turned = made.observations;
  Random random(3, "order");
  for (std::size_t i = turned.size(); i > 1; --i) std::swap(turned[i - 1], turned[random.uniform_index(i)]);
  const auto second = merge_observations(turned, made.types, Crs::local());
  ASSERT_EQ(first.landmarks.size(), second.landmarks.size());
  for (std::size_t i = 0; i < first.landmarks.size(); ++i) {
    EXPECT_EQ(first.landmarks[i].uid, second.landmarks[i].uid);
    EXPECT_EQ(first.landmarks[i].position, second.landmarks[i].position);
    EXPECT_EQ(first.landmarks[i].covariance, second.landmarks[i].covariance);
  }
  for (std::size_t i = 0; i < first.evidence.size(); ++i)
    EXPECT_EQ(first.evidence[i].landmark_uid, second.evidence[i].landmark_uid);
}

// Detections arrive by image, tile and thread: the map is bit-identical for any partition and order.
TEST(Landing, MergingDoesNotDependOnTiles) {
  const MadeLanding made = made_landing(landing(18, 0.3, 0.04, 0.05));
  const auto whole = merge_observations(made.observations, made.types, Crs::local());
  Random random(5, "tiles");
  for (const double side : {7.0, 31.0, 250.0}) {
    const double shift = random.uniform(0, side);
    std::map<std::uint64_t, std::vector<Observation>> tiles;
    std::map<std::pair<long, long>, std::uint64_t> rank;
    for (const Observation& o : made.observations) {
      const std::pair<long, long> tile{std::lround(std::floor((o.position.xyz.x() + shift) / side)),
                                       std::lround(std::floor((o.position.xyz.y() + shift) / side))};
      if (!rank.contains(tile)) rank[tile] = random.bits();
      tiles[rank[tile]].push_back(o);
    }
    std::vector<Observation> joined;
    for (const auto& [place, part] : tiles) joined.insert(joined.end(), part.rbegin(), part.rend());
    ASSERT_EQ(joined.size(), made.observations.size());
    const auto again = merge_observations(joined, made.types, Crs::local());
    ASSERT_EQ(again.landmarks.size(), whole.landmarks.size()) << "tiles of " << side << " m";
    for (std::size_t i = 0; i < whole.landmarks.size(); ++i) {
      ASSERT_EQ(again.landmarks[i].uid, whole.landmarks[i].uid);
      ASSERT_EQ(again.landmarks[i].position, whole.landmarks[i].position);
      ASSERT_EQ(again.landmarks[i].covariance, whole.landmarks[i].covariance);
    }
  }
}

// Distant observations have no effect: a copy of the landing a kilometre away changes nothing.
TEST(Landing, MergingIsLocal) {
  const MadeLanding made = made_landing(landing(19, 0.3, 0.04, 0.05));
  const auto alone = merge_observations(made.observations, made.types, Crs::local());
  auto both = made.observations;
  for (Observation o : made.observations) {
    o.position.xyz.x() += 1024;
    both.push_back(o);
  }
  const auto merged = merge_observations(both, made.types, Crs::local());
  ASSERT_EQ(merged.landmarks.size(), 2 * alone.landmarks.size());
  std::map<std::string, Eigen::Vector3d> here;
  for (const Landmark& l : merged.landmarks) here[l.uid] = l.position.xyz;
  for (const Landmark& l : alone.landmarks) {
    ASSERT_TRUE(here.contains(l.uid));
    EXPECT_EQ(here[l.uid], l.position.xyz);
  }
}

TEST(Landing, RockHeightsAndCraterDepthsAreRight) {
  const MadeLanding made = made_landing(landing(17, 0, 0, 0.05));
  std::vector<double> heights, depths;
  for (std::size_t i = 0; i < made.observations.size(); ++i) {
    if (made.thing[i] < 0) continue;
    const auto t = static_cast<std::size_t>(made.thing[i]);
    const auto& features = made.observations[i].features;
    if (t >= made.scene.craters.size())
      heights.push_back(features[1].value / made.scene.rocks[t - made.scene.craters.size()].height);
    else if (features[1].known() && made.scene.craters[t].diameter() > 14)
      depths.push_back(features[1].value / made.scene.craters[t].depth);
  }
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  ASSERT_GT(heights.size(), 50u);
  ASSERT_GT(depths.size(), 12u);
  EXPECT_NEAR(median(heights), 1, 0.05);
  EXPECT_NEAR(median(depths), 1, 0.1);
}

}  // namespace
}  // namespace waymark::test
