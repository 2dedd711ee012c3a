// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/bearing_starts.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/random.hpp"
#include "localization/motion_model.hpp"
#include "localization/slam/ekf_slam.hpp"

namespace waymark::test {
using namespace localization;
namespace {

constexpr OdometryNoise kRoverNoise{.along_per_metre = 1e-4,
                                    .across_per_metre = 1e-4,
                                    .yaw_per_metre = 1e-5,
                                    .yaw_per_radian = 1e-5,
                                    .position_per_second = 0,
                                    .yaw_per_second = 0};

std::vector<Eigen::Vector2d> made_objects(Random& random, int count) {
  std::vector<Eigen::Vector2d> all;
  while (std::ssize(all) < count) {
    const Eigen::Vector2d at(random.uniform(0, 40), random.uniform(-15, 15));
    if (std::abs(at.y()) > 3) all.push_back(at);
  }
  return all;
}

/// A camera on a robot that drives along x and sees the direction of what is within 20 m.
SightingSet look(const Pose2& robot, const std::vector<Eigen::Vector2d>& objects, bool named,
                 Random& random) {
  SightingSet seen;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Eigen::Vector2d d = objects[i] - robot.at();
    if (d.norm() > 20) continue;
    SeenLandmark s;
    s.bearing = wrap_angle(std::atan2(d.y(), d.x()) - robot.yaw + random.normal(0, 0.005));
    s.bearing_sd = 0.005;
    if (named) s.identity = i + 1;
    seen.sightings.push_back(s);
  }
  return seen;
}

Pose2 drive(Pose2& truth, BodyMotion& motion, Random& random) {
  motion = twist_motion(0.5, 0, 0.02, 1, kRoverNoise);
  const Eigen::Vector3d sd = motion.covariance.diagonal().cwiseSqrt();
  truth = truth * pose_of(motion.step.vector() + sd.cwiseProduct(Eigen::Vector3d(
                                                     random.normal(), random.normal(), random.normal())));
  return truth;
}

TEST(BearingStarts, PositionsErrAsMuchAsTheyClaim) {
  double squares = 0;
  int starts = 0, objects_seen = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed, "bearings");
    const auto objects = made_objects(random, 12);
    BearingStarts bearings;
    Pose2 truth;
    std::vector<bool> started(objects.size(), false);
    objects_seen += 12;
    for (int step = 0; step < 60; ++step) {
      BodyMotion motion;
      drive(truth, motion, random);
      bearings.predict(motion);
      const SightingSet seen = look(truth, objects, true, random);
      std::vector<std::size_t> fresh;
      for (std::size_t i = 0; i < seen.sightings.size(); ++i)
        if (!started[*seen.sightings[i].identity - 1]) fresh.push_back(i);
      for (const BearingStarts::Start& s : bearings.add(seen, fresh, true)) {
        const std::size_t object = *seen.sightings[s.sighting].identity - 1;
        const Eigen::Vector2d off =
            s.at - (inverse(truth) * Pose2{objects[object].x(), objects[object].y(), 0}).at();
        squares += off.dot(s.covariance.inverse() * off) / 2;
        started[object] = true;
        ++starts;
      }
    }
  }
  EXPECT_GT(starts, 0.7 * objects_seen);
  // About 200 starts of two coordinates: 0.90 to 1.10 (95 %) if the errors were Gaussian.
  EXPECT_GT(squares / starts, 0.7);
  EXPECT_LT(squares / starts, 1.4);
}

TEST(BearingStarts, AnObjectInTheDirectionOfTheMotionHasNoRange) {
  Random random(1, "ahead");
  BearingStarts bearings;
  Pose2 truth;
  for (int step = 0; step < 30; ++step) {
    const BodyMotion motion = twist_motion(0.5, 0, 0, 1, kRoverNoise);
    truth = truth * motion.step;
    bearings.predict(motion);
    EXPECT_TRUE(bearings.add(look(truth, {{20.4, 0}}, false, random), {0}, false).empty()) << step;
  }
  EXPECT_EQ(bearings.objects(), 1u);
}

TEST(BearingStarts, TwoObjectsThatMayBeOneStartNothing) {
  Random random(2, "two");
  BearingStarts bearings;
  Pose2 truth;
  int starts = 0;
  for (int step = 0; step < 40; ++step) {
    const BodyMotion motion = twist_motion(0.5, 0, 0, 1, kRoverNoise);
    truth = truth * motion.step;
    bearings.predict(motion);
    const SightingSet seen = look(truth, {{12, 6}, {12.1, 6.1}}, false, random);
    std::vector<std::size_t> all(seen.sightings.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    starts += static_cast<int>(bearings.add(seen, all, false).size());
  }
  EXPECT_EQ(starts, 0);
}

// SLAM without a map and without a range: the landmarks lie where they are, within what is claimed.
TEST(EkfSlam, BearingsAloneStartLandmarks) {
  for (const bool named : {true, false}) {
    double squares = 0;
    int landmarks = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      Random random(seed, "bearing slam");
      const auto objects =
          made_objects(random, named ? 10 : 4);  // without names only where few may be confused
      IdentificationOptions identification;
      identification.use_identities = named;
      EkfSlam slam({{}, 1e-8 * Eigen::Matrix3d::Identity()}, {.identification = identification});
      Pose2 truth;
      for (int step = 0; step < 60; ++step) {
        BodyMotion motion;
        drive(truth, motion, random);
        slam.predict(motion);
        slam.update(look(truth, objects, named, random));
      }
      const Eigen::Vector2d off = slam.estimate().pose.at() - truth.at();
      EXPECT_LT(off.norm(), 1) << named << ' ' << seed;
      for (const SlamLandmark& l : slam.landmarks()) {
        if (l.gone || l.matches < 5) continue;
        double nearest = 1e9;
        Eigen::Vector2d error = Eigen::Vector2d::Zero();
        for (const Eigen::Vector2d& o : objects)
          if ((o - l.at).norm() < nearest) nearest = (o - l.at).norm(), error = o - l.at;
        squares += error.dot(l.covariance.inverse() * error) / 2;
        ++landmarks;
      }
    }
    EXPECT_GT(landmarks, named ? 40 : 8) << named;
    EXPECT_LT(squares / landmarks, 3) << named;
  }
}

}  // namespace
}  // namespace waymark::test
