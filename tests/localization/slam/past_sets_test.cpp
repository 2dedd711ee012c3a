// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/past_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "localization/slam/ekf_slam.hpp"

namespace waymark::test {
using namespace localization;
namespace {

const Eigen::Matrix3d kSure = Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal();

SeenLandmark polar_sighting(double range, double bearing) {
  SeenLandmark s;
  s.range = range, s.range_sd = 0.03;
  s.bearing = bearing, s.bearing_sd = 0.01;
  return s;
}

SightingSet two_sightings() {
  SightingSet seen;
  seen.sightings = {polar_sighting(3, 0.5), polar_sighting(4, -0.5)};
  return seen;
}

// The map explains all sightings of a robot with y < 5.
std::vector<bool> explain_route(const SightingSet& seen, const PoseEstimate& robot) {
  return std::vector<bool>(seen.sightings.size(), robot.pose.y < 5);
}

// Drives 10 m along x, then turns into a room.
PastSets made_past() {
  PastSets past;
  for (int i = 0; i <= 20; ++i) {
    past.predict({{i ? 0.5 : 0, 0, 0}});
    past.add(two_sightings(), {{0.5 * i, 0, 0}, kSure}, 2, 2);
  }
  return past;
}

TEST(PastSets, ContradictAPoseThatOdometryCannotReach) {
  const PastSets past = made_past();
  const PoseEstimate here{{10, 0, 0}, kSure};
  EXPECT_EQ(past.size(), 21u);
  EXPECT_TRUE(past.contradict({{10, 20, 0}, kSure}, here, explain_route));
  EXPECT_FALSE(past.contradict({{10, -20, 0}, kSure}, here, explain_route))
      << "it explains the route as well";
}

TEST(PastSets, DoNotContradictWhatOdometryMayHaveMissed) {
  const PoseEstimate here{{10, 0, 0}, kSure};
  const Eigen::Matrix3d poor = Eigen::Vector3d(9, 9, 1e-4).asDiagonal();
  EXPECT_FALSE(made_past().contradict({{10, 1.5, 0}, kSure}, here, [](const auto&, const PoseEstimate& e) {
    return std::vector<bool>(2, e.pose.y < 1);
  }));
  EXPECT_FALSE(made_past().contradict({{10, 15, 0}, poor}, here, explain_route));
}

TEST(PastSets, MoveWithARobotThatRestarts) {
  PastSets past = made_past();
  past.move({10, 0, 0}, {10, 20, 0});
  EXPECT_FALSE(past.contradict({{10, 0, 0}, kSure}, {{10, 20, 0}, kSure}, explain_route));
  EXPECT_TRUE(past.contradict({{10, 20, 0}, kSure}, {{10, 0, 0}, kSure},
                              [](const SightingSet&, const PoseEstimate& e) {
                                return std::vector<bool>(2, e.pose.y > 5 && e.pose.y < 30);
                              }));
}

TEST(PastSets, AreForgottenByARobotThatKnowsNothingThatItSees) {
  PastSets past = made_past();
  for (int i = 0; i < 3; ++i) past.add(two_sightings(), {{10, 0, 0}, kSure}, 0, 2);
  EXPECT_EQ(past.size(), 21u) << "a few new objects are nothing strange";
  for (int i = 0; i < 3; ++i) past.add(two_sightings(), {{10, 0, 0}, kSure}, 0, 2);
  EXPECT_EQ(past.size(), 0u);
}

/// A corridor along x and a room at its end. The map has the corridor and, 40 m beside the room, another
/// that looks alike.
class AlikeRooms {
 public:
  explicit AlikeRooms(std::uint64_t seed) : random_(seed) {
    for (int i = 0; i < 30; ++i) corridor_.emplace_back(0.8 * i, (i % 2 ? 3 : -3) + uniform(-1, 1));
    for (int i = 0; i < 30; ++i) room_.emplace_back(28 + uniform(0, 18), uniform(-6, 6));
  }

  LandmarkGrid map() const {
    std::vector<MapLandmark> all;
    const auto add = [&](const Eigen::Vector2d& at) {
      MapLandmark l;
      l.key = all.size() + 1, l.at = at, l.covariance = 1e-4 * Eigen::Matrix2d::Identity();
      all.push_back(l);
    };
    for (const Eigen::Vector2d& at : corridor_) add(at);
    for (const Eigen::Vector2d& at : room_) add(at + beside());
    return LandmarkGrid(all);
  }
  static Eigen::Vector2d beside() { return {0, 40}; }

  /// Returns what a robot sees from the corridor or the room; of the room beside alike.
  SightingSet look(const Pose2& from) {
    SightingSet seen;
    for (const auto* objects : {&corridor_, &room_}) {
      for (const Eigen::Vector2d& at : *objects) {
        const Eigen::Vector2d to = (inverse(from) * Pose2{at.x(), at.y(), 0}).at();
        if (to.norm() > 8 || std::abs(std::atan2(to.y(), to.x())) > 1.3) continue;
        seen.sightings.push_back(
            polar_sighting(to.norm() + gauss(0.03), std::atan2(to.y(), to.x()) + gauss(0.01)));
      }
    }
    return seen;
  }

  BodyMotion drive(Pose2& truth) {
    const Pose2 step{0.2, 0, 0};
    truth = truth * step;
    return {{step.x + gauss(0.01), gauss(0.005), gauss(0.003)},
            Eigen::Vector3d(1e-4, 2.5e-5, 9e-6).asDiagonal()};
  }

 private:
  double uniform(double a, double b) { return std::uniform_real_distribution(a, b)(random_); }
  double gauss(double sd) { return std::normal_distribution(0.0, sd)(random_); }
  std::mt19937_64 random_;
  std::vector<Eigen::Vector2d> corridor_, room_;
};

EkfSlam made_slam(const AlikeRooms& site) {
  SlamOptions options;
  options.max_range = 12, options.nearest = 0.5;
  return {{{-2, 0, 0}, kSure}, site.map(), {}, options};
}

// Without the past, the room beside explains all that is seen, the true pose nothing.
TEST(PastSets, ARoomThatLooksAlikeIsNotTheRobots) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    AlikeRooms site(seed);
    EkfSlam slam = made_slam(site);
    Pose2 truth{-2, 0, 0};
    int calls = 0;
    slam.set_pose_finder([&](const SightingSet&) {
      PoseSearchResult found;
      if (truth.x < 26) return found;
      ++calls;
      found.accepted = PoseEstimate{{truth.x, truth.y + AlikeRooms::beside().y(), truth.yaw}, 10 * kSure};
      return found;
    });
    for (int i = 0; i < 200; ++i) {
      slam.predict(site.drive(truth));
      slam.update(site.look(truth));
      ASSERT_LT((slam.estimate().pose.at() - truth.at()).norm(), 1) << "seed " << seed << ", set " << i;
    }
    EXPECT_GT(calls, 2) << seed;
    EXPECT_EQ(slam.restarts(), 0) << seed;
  }
}

TEST(PastSets, DoNotHoldARobotThatWasCarried) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    AlikeRooms site(seed);
    EkfSlam slam = made_slam(site);
    Pose2 truth{-2, 0, 0};
    bool is_carried = false;
    const auto there = [&] {  // in the room beside, which looks like the one where `truth` is
      return Pose2{truth.x, truth.y + AlikeRooms::beside().y(), truth.yaw};
    };
    slam.set_pose_finder([&](const SightingSet&) {
      PoseSearchResult found;
      if (is_carried) found.accepted = PoseEstimate{there(), 10 * kSure};
      return found;
    });
    for (int i = 0; i < 140; ++i) {
      if (i == 80) truth = {30, 0, 0}, is_carried = true;
      slam.predict(site.drive(truth));
      slam.update(site.look(truth));
    }
    EXPECT_EQ(slam.restarts(), 1) << seed;
    EXPECT_LT((slam.estimate().pose.at() - there().at()).norm(), 0.5) << seed;
  }
}

}  // namespace
}  // namespace waymark::test
