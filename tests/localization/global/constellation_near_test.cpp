// SPDX-License-Identifier: Apache-2.0
// Search of the poses that odometry allows, in maps that lack most objects.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/localization/made_look.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
namespace {

constexpr double kMapped = 0.2;  // of the objects

/// Objects on a plane, the map of some of them, and a robot with a prior of its pose.
struct NearScene {
  std::vector<MapLandmark> objects, mapped;
  Pose2 robot;
  PoseEstimate prior;
  SightingSet seen;

  NearScene(std::uint64_t seed, double position_sd, double yaw_sd, Random& random) {
    objects = scatter_landmarks(5000, 500, seed, 0.05);
    for (MapLandmark& l : objects) {
      l.features.value[0] = random.log_uniform(0.2, 1);
      if (random.bernoulli(kMapped)) mapped.push_back(l);
    }
    std::vector<LandmarkPosition> positions;
    for (const MapLandmark& l : objects)
      positions.push_back({.at = {l.at.x(), l.at.y(), 0}, .up = Eigen::Vector3d::UnitZ()});
    robot = {random.uniform(-200, 200), random.uniform(-200, 200), random.uniform(-3, 3)};
    prior.pose = {robot.x + random.normal(0, position_sd), robot.y + random.normal(0, position_sd),
                  robot.yaw + random.normal(0, yaw_sd)};
    prior.covariance =
        Eigen::Vector3d(position_sd * position_sd, position_sd * position_sd, yaw_sd * yaw_sd).asDiagonal();
    seen = look(objects, positions, {}, robot, {.reach = 25}, random).set;
  }
};

TEST(ConstellationNear, FindsPosesThatASearchOfTheWholeMapCannotProve) {
  Random random(3, "near");
  int found = 0, wrong = 0, of_whole_map = 0, scrambled = 0;
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const NearScene scene(seed, 3, 0.1, random);
    const ConstellationIndex index(scene.mapped, {});
    of_whole_map += index.find(scene.seen).fix.has_value();
    if (const auto answer = index.find_near(scene.seen, scene.prior); answer.fix) {
      const bool right = (answer.fix->pose().pose.at() - scene.robot.at()).norm() < 0.5;
      ++(right ? found : wrong);
      if (right) squares += nees(answer.fix->pose(), scene.robot);
    }
    scrambled += index.find_near(scramble_bearings(scene.seen, random), scene.prior).fix.has_value();
  }
  std::printf("%d of 60 found, %d wrong, %d scrambled; search of the whole map %d; NEES %.2f\n", found, wrong,
              scrambled, of_whole_map, squares / found);
  EXPECT_GE(found, 36);
  EXPECT_GT(found, of_whole_map + 10);
  EXPECT_EQ(wrong + scrambled, 0);
  EXPECT_NEAR(squares / found / 3, 1, 0.4);
}

// The slow twin: the pose of a fine grid at which most sightings have a landmark.
TEST(ConstellationNear, AgreesWithEveryPoseOfAGrid) {
  Random random(4, "grid");
  int compared = 0;
  for (std::uint64_t seed = 101; seed <= 106; ++seed) {
    const NearScene scene(seed, 0.8, 0.04, random);
    const auto answer = ConstellationIndex(scene.mapped, {}).find_near(scene.seen, scene.prior);
    if (!answer.fix) continue;
    std::vector<MapLandmark> close;
    for (const MapLandmark& l : scene.mapped)
      if ((l.at - scene.prior.pose.at()).norm() < 30) close.push_back(l);
    int most = 0;
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    for (int x = -12; x <= 12; ++x)
      for (int y = -12; y <= 12; ++y)
        for (int t = -12; t <= 12; ++t) {
          const Pose2 pose{scene.prior.pose.x + 0.2 * x, scene.prior.pose.y + 0.2 * y,
                           scene.prior.pose.yaw + 0.01 * t};
          int fits = 0;
          for (const SeenLandmark& s : scene.seen.sightings) {
            const double along = pose.yaw + *s.bearing;
            const Eigen::Vector2d at =
                pose.at() + *s.range * Eigen::Vector2d(std::cos(along), std::sin(along));
            fits +=
                std::ranges::any_of(close, [&](const MapLandmark& l) { return (l.at - at).norm() < 0.4; });
          }
          if (fits > most) most = fits, best = {pose.x, pose.y, pose.yaw};
        }
    EXPECT_LT((answer.fix->pose().pose.at() - best.head<2>()).norm(), 0.7) << seed;
    EXPECT_GE(answer.fix->matched, most - 2) << seed;
    ++compared;
  }
  EXPECT_GE(compared, 4);
}

TEST(ConstellationNear, SaysWhyThereIsNone) {
  Random random(5, "none");
  const NearScene scene(7, 1, 0.05, random);
  EXPECT_EQ(ConstellationIndex({}, {}).find_near(scene.seen, scene.prior).reason, "the map is empty");
  SightingSet few = scene.seen;
  few.sightings.resize(3);
  const ConstellationIndex index(scene.mapped, {});
  EXPECT_EQ(index.find_near(few, scene.prior).reason, kTooFewSightings);
  PoseEstimate away = scene.prior;
  away.pose.x += 1000;
  EXPECT_EQ(index.find_near(scene.seen, away).reason, "no such constellation near");
  // A prior of the size of a planet is no prior; the search ends at once.
  away.covariance *= 1e12;
  EXPECT_FALSE(index.find_near(scene.seen, away).fix);
}

}  // namespace
}  // namespace waymark::test
