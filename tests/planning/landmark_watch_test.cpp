// SPDX-License-Identifier: Apache-2.0
#include "planning/landmark_watch.hpp"

#include <gmock/gmock.h>

#include <cmath>
namespace waymark::test {
using namespace planning;
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

localization::LandmarkGrid two_landmarks() {
  localization::MapLandmark near, beside;
  near.key = 1, near.at = {5, 0}, near.quality = 0.9;
  beside.key = 2, beside.at = {0, 5}, beside.quality = 0.9;
  return localization::LandmarkGrid({near, beside});
}

localization::PoseEstimate pose(double sd = 0.1) {
  return {{0, 0, 0}, Eigen::Vector3d(sd * sd, sd * sd, 1e-4).asDiagonal()};
}

const LandmarkSensing kAhead{.coverage = {.range = 15, .view = 90, .detection = 0.8}};

TEST(LandmarkWatch, MissesOfALandmarkInViewAreCountedAsLogOdds) {
  LandmarkWatch watch(two_landmarks(), kAhead);
  // ln 9 + n ln(1 - 0.5 x 0.8) falls below -2.2 at the ninth miss.
  for (int i = 0; i < 8; ++i) watch.add(pose(), {});
  EXPECT_THAT(watch.gone(), IsEmpty());
  watch.add(pose(), {});
  EXPECT_THAT(watch.gone(), ElementsAre(1u));  // the other one is outside the view
  EXPECT_LT(std::log(9) + 9 * std::log(0.6), -2.2);
  EXPECT_GT(std::log(9) + 8 * std::log(0.6), -2.2);
}

TEST(LandmarkWatch, DoubtfulLandmarksThatFiltersLeaveOutAreNotGone) {
  localization::MapLandmark likely, doubtful;
  likely.key = 1, likely.at = {0, 5}, likely.quality = 0.9;
  doubtful.key = 2, doubtful.at = {5, 0}, doubtful.quality = 0.4;
  LandmarkWatch beside(localization::LandmarkGrid({likely, doubtful}), kAhead);
  LandmarkWatch alone(localization::LandmarkGrid({doubtful}), kAhead);
  for (int i = 0; i < 50; ++i) beside.add(pose(), {}), alone.add(pose(), {});
  EXPECT_THAT(beside.gone(), IsEmpty());
  EXPECT_THAT(alone.gone(), ElementsAre(2u));
}

TEST(LandmarkWatch, AMatchProvesThatItIsThere) {
  LandmarkWatch watch(two_landmarks(), kAhead);
  localization::Match match;
  match.verdict = localization::Verdict::matched;
  match.key = 1;
  watch.add(pose(), {&match, 1});
  for (int i = 0; i < 50; ++i) watch.add(pose(), {});
  EXPECT_THAT(watch.gone(), IsEmpty());
}

TEST(LandmarkWatch, APoorPoseSaysNothing) {
  LandmarkWatch watch(two_landmarks(), kAhead);
  for (int i = 0; i < 50; ++i) watch.add(pose(1.1), {});
  EXPECT_THAT(watch.gone(), IsEmpty());
}

TEST(LandmarkWatch, AMapWithoutTheGoneKeepsTheOthers) {
  const localization::LandmarkKey gone[] = {1};
  const localization::LandmarkGrid kept = map_without(two_landmarks(), gone);
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].key, 2u);
}

}  // namespace
}  // namespace waymark::test
