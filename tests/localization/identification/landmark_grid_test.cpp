// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/landmark_grid.hpp"

#include <gtest/gtest.h>

#include <map>

#include "localization/filters/sighting_score.hpp"
#include "localization/identification/identification.hpp"
#include "localization/identification/landmark_window.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

std::vector<MapLandmark> scatter_doubtful_landmarks(std::size_t count, double side, std::uint64_t seed) {
  Random random(seed, "existence");
  std::vector<MapLandmark> all = scatter_landmarks(count, side, seed);
  for (MapLandmark& l : all) {
    l.type = static_cast<TypeId>(random.uniform_index(2));
    l.quality = random.bernoulli(0.1) ? 0.5 : random.log_uniform(0.02, 1);
    l.has_confidence = random.bernoulli(0.9);
    if (random.bernoulli(0.1)) l.normal = {1, 0}, l.half_length = 2;
    l.outweighed = random.bernoulli(0.5);  // of an earlier map: must not stay
  }
  return all;
}

/// Slow twin: every landmark is compared with every other.
bool is_outweighed(const MapLandmark& l, const std::vector<MapLandmark>& all) {
  if (l.quality >= 0.5 || !l.has_confidence || l.is_line()) return false;
  double likely = 0, doubtful = 0;
  for (const MapLandmark& other : all)
    if (other.type == l.type && (other.at - l.at).norm() <= kOutweighedRadius)
      (other.quality >= 0.5 ? likely : doubtful) += other.quality;
  return likely > doubtful;
}

TEST(LandmarkGrid, MarksDoubtfulLandmarksWhereLikelyOnesAreMostOfThoseThatExist) {
  std::size_t marked = 0, kept = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto all = scatter_doubtful_landmarks(seed % 5 ? 150 : 3, seed % 3 ? 200 : 20, seed);
    const LandmarkGrid grid(all);
    for (const MapLandmark& l : grid.landmarks()) {
      ASSERT_EQ(l.outweighed, is_outweighed(l, all)) << "seed " << seed << ", landmark " << l.key;
      if (l.quality < 0.5) ++(l.outweighed ? marked : kept);
    }
  }
  EXPECT_GT(marked, 500u);
  EXPECT_GT(kept, 500u);
}

TEST(LandmarkWindow, MarksTheSameLandmarksAsTheWholeMap) {
  const auto all = scatter_doubtful_landmarks(3000, 600, 7);
  std::map<LandmarkKey, bool> marks;
  const LandmarkGrid whole(all);
  for (const MapLandmark& l : whole.landmarks()) marks[l.key] = l.outweighed;
  LandmarkWindow window([&](const Eigen::AlignedBox2d& box) { return landmarks_in(box, all); }, 5);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d at(-250 + 5 * i, 40);
    const LandmarkGrid& near = window.landmarks_near(at, 20);
    near.near(at, 20, [&](std::uint32_t k) { ASSERT_EQ(near[k].outweighed, marks[near[k].key]); });
  }
}

// A doubtful landmark at 10 m fits an unmapped object exactly; two likely ones stand beside the robot.
struct DoubtfulSite {
  LandmarkGrid map;
  SightingSet seen;

  DoubtfulSite() {
    MapLandmark doubtful = landmark_at(10, 0, 1);
    doubtful.quality = 0.3;
    map = LandmarkGrid({doubtful, landmark_at(0, 5, 2), landmark_at(0, -5, 3)});
    seen = {{}, {seen_at(10, 0)}};
  }
};

TEST(Identify, LeavesOutDoubtfulLandmarksBesideLikelyOnes) {
  const DoubtfulSite site;
  const auto verdict = [&](const SightingSet& seen, const IdentificationOptions& options) {
    return identify(seen, {}, site.map, {}, options).matches[0].verdict;
  };
  EXPECT_EQ(verdict(site.seen, {}), Verdict::nothing_near);
  EXPECT_EQ(verdict(site.seen, {.quality_floor = 1}), Verdict::matched);
  EXPECT_EQ(verdict(site.seen, {.quality = "paper"}), Verdict::matched);
  EXPECT_EQ(verdict(site.seen, {.distance = "paper"}), Verdict::matched);
  SightingSet known = site.seen;
  known.sightings[0].identity = 1;  // one that the robot identified exists
  EXPECT_EQ(verdict(known, {}), Verdict::matched);
  EXPECT_EQ(verdict(known, {.use_identities = false}), Verdict::nothing_near);
}

TEST(SightingScore, LeavesOutDoubtfulLandmarksBesideLikelyOnes) {
  const DoubtfulSite site;
  const auto score = [&](SightingSet seen, const IdentificationOptions& options, bool prefetched) {
    SightingScore all(seen, site.map, {}, {}, options);
    if (prefetched) all.prefetch(std::vector<Pose2>{{}, {}});
    return all(Pose2{});
  };
  SightingSet remote = site.seen, known = site.seen;
  *remote.sightings[0].range = 40;  // no landmark is there
  known.sightings[0].identity = 1;
  for (const bool prefetched : {false, true}) {
    EXPECT_EQ(score(site.seen, {}, prefetched), score(remote, {}, prefetched));
    EXPECT_GT(score(site.seen, {.quality_floor = 1}, prefetched), score(remote, {}, prefetched) + 1);
    EXPECT_GT(score(known, {}, prefetched), score(remote, {}, prefetched) + 1);
  }
}

}  // namespace
}  // namespace waymark::test
