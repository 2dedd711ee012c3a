// SPDX-License-Identifier: Apache-2.0
#include "localization/global/range_resection.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "localization/global/range_memory.hpp"
#include "tests/localization/made_beacons.hpp"

namespace waymark::test {
using namespace localization;
namespace {

struct RangeSearch {
  int accepted = 0, wrong = 0;
  double squares = 0;
};

RangeSearch search_by_ranges(const BeaconSettings& settings, int steps, std::uint64_t first, int seeds) {
  RangeSearch result;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(seeds); ++seed) {
    BeaconDrive drive(seed, settings);
    RangeMemory memory;
    for (int i = 0; i < steps; ++i) {
      memory.predict(drive.drive());
      memory.add(drive.look());
    }
    const PoseSearchResult found = resect(memory.recall(), LandmarkGrid(drive.map()));
    if (!found.accepted) continue;
    ++result.accepted;
    result.wrong += (found.accepted->pose.at() - drive.truth().at()).norm() > 2;
    result.squares += nees(*found.accepted, drive.truth()) / 3;
  }
  return result;
}

TEST(RangeResection, FindsThePoseOnlyIfItIsTheOnlyOne) {
  struct Case {
    const char* what;
    BeaconSettings settings;
    int steps, min_accepted, max_accepted;
  };
  constexpr int kSeeds = 40;
  const Case cases[] = {{"four beacons", {}, 60, 38, kSeeds},
                        {"with a mount", {.mount = {0.8, -0.5, 1.2}}, 60, 38, kSeeds},
                        {"outliers", {.outliers = 0.1}, 80, 34, kSeeds},
                        {"two beacons, a turn", {.beacons = 2}, 120, 20, kSeeds},
                        {"two beacons, straight", {.beacons = 2, .straight = true}, 40, 0, 2},
                        {"one beacon", {.beacons = 1}, 100, 0, 0},
                        {"few ranges", {}, 3, 0, 2}};
  for (const Case& c : cases) {
    const RangeSearch s = search_by_ranges(c.settings, c.steps, 1001, kSeeds);
    std::printf("%-22s accepted %d of %d, wrong %d, nees %.2f\n", c.what, s.accepted, kSeeds, s.wrong,
                s.squares / std::max(1, s.accepted));
    EXPECT_EQ(s.wrong, 0) << c.what;
    EXPECT_GE(s.accepted, c.min_accepted) << c.what;
    EXPECT_LE(s.accepted, c.max_accepted) << c.what;
    if (c.min_accepted > 30) {
      EXPECT_LT(s.squares / s.accepted, 1.7) << c.what;
    }
  }
}

TEST(RangeMemory, PlacesFollowTheRobot) {
  RangeMemory memory;
  SeenLandmark seen;
  seen.range = 5, seen.range_sd = 0.3, seen.identity = 7;
  memory.add({{1, 0, 0}, {seen}});
  memory.predict({{2, 0, std::numbers::pi / 2}, Eigen::Vector3d(0.04, 0.01, 0.01).asDiagonal()});
  memory.add({{}, {seen}});
  memory.add({{}, {seen}});  // at the same place
  memory.predict({{1, 0, 0}, Eigen::Matrix3d::Zero()});
  const std::vector<EarlierRange> all = memory.recall();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_LT((all[0].from - Eigen::Vector2d(-1, 1)).norm(), 1e-12);  // 1 m left of the corner, 1 m behind
  EXPECT_LT((all[1].from - Eigen::Vector2d(-1, 0)).norm(), 1e-12);
  EXPECT_EQ(all[0].landmark, 7u);
  EXPECT_EQ(all[0].sd, 0.3);
  EXPECT_NEAR(all[1].motion.norm(), 0, 1e-12);
  // The turn of the first motion acts about its end, 1 m behind the robot.
  EXPECT_NEAR(all[0].motion(2, 2), 0.01, 1e-12);
  EXPECT_NEAR(all[0].motion(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(all[0].motion(1, 1), 0.04 + 0.01, 1e-12);
}

}  // namespace
}  // namespace waymark::test
