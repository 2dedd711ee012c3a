// SPDX-License-Identifier: Apache-2.0
#include "localization/robot_log.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "localization/filters/kalman.hpp"
#include "localization/replay_log.hpp"
#include "localization/track_score.hpp"
#include "made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

SightingSet one(double range, double bearing) {
  return {{}, {seen_at(range, bearing)}};
}

/// South polar stereographic, at 90 degrees east: x grows to the north. The robot drives along x.
TEST(RobotLog, YawsAlongTheAxesOfACrsAreTurnedToTheMapFrame) {
  const Crs polar = Crs::from_text("IAU_2015:30135");
  const auto at = CrsTransform(geographic_crs(polar), polar)(90, -89);
  RobotLog log;
  log.in_crs = true;
  log.start = Pose2{at.x, at.y, 0};
  log.truth = {{0, *log.start}, {1, Pose2{at.x + 10, at.y, 0}}};
  log.events = {{0, HeadingFix{.yaw = 0.1, .sd = 0.02}}};
  convert_to_map_frame(log, LocalFrame(polar, {{at.x, at.y, 0}}));
  EXPECT_NEAR(log.start->yaw, std::numbers::pi / 2, 1e-6);
  EXPECT_NEAR(std::get<HeadingFix>(log.events[0].what).yaw, std::numbers::pi / 2 + 0.1, 1e-6);
  const Eigen::Vector2d along = log.truth[1].pose.at() - log.truth[0].pose.at();
  EXPECT_NEAR(along.y(), 10, 0.1);
  EXPECT_NEAR(std::atan2(along.y(), along.x()), log.truth[1].pose.yaw, 1e-4) << "it drives ahead";
}

TEST(RepeatedSightings, ASecondLookSaysWhatItsCorrelationLeaves) {
  RepeatedSightings repeated({.range = 3, .bearing = 1});
  SightingSet first = one(5, 0.2);
  repeated.widen(first, 10);
  EXPECT_EQ(first.sightings[0].range_sd, 0.1);
  SightingSet second = one(5.05, 0.21);
  repeated.widen(second, 10.5);
  const double range = std::exp(-0.5 / 3), bearing = std::exp(-0.5);
  EXPECT_NEAR(second.sightings[0].range_sd, 0.1 * std::sqrt((1 + range) / (1 - range)), 1e-12);
  EXPECT_NEAR(second.sightings[0].bearing_sd, 0.02 * std::sqrt((1 + bearing) / (1 - bearing)), 1e-12);
  // Another landmark, and the same one long after.
  for (const auto& [range_now, t] : {std::pair{8.0, 10.6}, std::pair{5.0, 60.0}}) {
    SightingSet other = one(range_now, 0.2);
    repeated.widen(other, t);
    EXPECT_EQ(other.sightings[0].range_sd, 0.1);
  }
}

TEST(RepeatedSightings, FollowTheRobotsMotion) {
  RepeatedSightings repeated({.range = 3, .bearing = 1});
  SightingSet first = one(5, 0);
  repeated.widen(first, 0);
  repeated.predict({{1, 0, 0.5}, Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal()});
  SightingSet there = one(4, -0.5), elsewhere = one(5, 0);
  repeated.widen(there, 1);
  EXPECT_GT(there.sightings[0].range_sd, 0.15);
  repeated.widen(elsewhere, 1);
  EXPECT_EQ(elsewhere.sightings[0].range_sd, 0.1);
  SightingSet unsound = one(std::nan(""), 0);
  repeated.widen(unsound, 2);
  SightingSet bearing = one(4, -0.5);
  bearing.sightings[0].range.reset();
  repeated.widen(bearing, 2);
  EXPECT_EQ(bearing.sightings[0].bearing_sd, 0.02);
}

TEST(RepeatedSightings, RangesWithoutBearingAreThoseOfOneIdentity) {
  RepeatedSightings repeated({.range = 3, .bearing = 1});
  const auto range = [&](std::optional<LandmarkKey> identity, double t) {
    SightingSet set = one(5, 0);
    set.sightings[0].bearing.reset(), set.sightings[0].identity = identity;
    repeated.widen(set, t);
    return set.sightings[0].range_sd;
  };
  EXPECT_EQ(range(7, 0), 0.1);
  EXPECT_EQ(range(8, 0.5), 0.1);
  const double alike = std::exp(-1.0 / 3);
  EXPECT_NEAR(range(7, 1), 0.1 * std::sqrt((1 + alike) / (1 - alike)), 1e-12);
  EXPECT_EQ(range({}, 1.1), 0.1);
}

/// A robot that sees beacons four times a second, with errors of correlation time `memory`, s.
RobotLog drive(std::uint64_t seed, double memory, const std::vector<MapLandmark>& beacons) {
  Random random(seed, "alike");
  RobotLog log;
  log.error_memory = {.range = memory, .bearing = memory};
  log.odometry = OdometryNoise{
      .along_per_metre = 0.01, .across_per_metre = 1e-3, .yaw_per_metre = 0.002, .yaw_per_radian = 0.01};
  const double dt = 0.25, alike = std::exp(-dt / memory);
  std::vector<Eigen::Vector2d> error;
  for (std::size_t i = 0; i < beacons.size(); ++i) error.emplace_back(random.normal(), random.normal());
  Pose2 at{0, -4, 0};
  for (int i = 0; i < 400; ++i) {
    const double t = dt * i;
    log.truth.push_back({t, at});
    SightingSet set;
    for (std::size_t l = 0; l < beacons.size(); ++l) {
      error[l] =
          alike * error[l] + std::sqrt(1 - alike * alike) * Eigen::Vector2d(random.normal(), random.normal());
      const Eigen::Vector2d d = beacons[l].at - at.at();
      const double bearing = wrap_angle(std::atan2(d.y(), d.x()) - at.yaw);
      if (std::abs(bearing) > 0.6) continue;
      SeenLandmark s = seen_at(d.norm() + 0.1 * error[l].x(), bearing + 0.02 * error[l].y());
      s.identity = beacons[l].key;
      set.sightings.push_back(s);
    }
    log.events.push_back({t, set});
    const Pose2 step = twist_motion(0.3, 0, 0.08, dt, {}).step;
    const BodyMotion noisy = twist_motion(0.3, 0, 0.08, dt, *log.odometry);
    const Eigen::Vector3d e = noisy.covariance.diagonal().cwiseSqrt().cwiseProduct(
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()));
    log.events.push_back({t + dt, StepReading{pose_of(step.vector() + e)}});
    at = at * step;
  }
  return log;
}

double anees(bool knows) {
  std::vector<MapLandmark> beacons;
  for (int i = 0; i < 10; ++i)
    beacons.push_back(
        landmark_at(6 * std::cos(0.63 * i), 6 * std::sin(0.63 * i), static_cast<LandmarkKey>(i + 1)));
  for (MapLandmark& l : beacons) l.covariance = Eigen::Matrix2d::Identity() * 1e-6;
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const RobotLog log = drive(seed, 3, beacons);
    ExtendedKalman filter({log.truth[0].pose, Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal()},
                          LandmarkMatcher(LandmarkWindow{LandmarkGrid(beacons)}));
    ReplayOptions options;
    options.error_memory = knows ? 1 : 0;
    sum += score(replay(log, filter, options), log.truth, TrackAlignment::none, true).consistency->anees / 60;
  }
  return sum;
}

TEST(RepeatedSightings, AFilterThatKnowsOfThemIsConsistent) {
  EXPECT_GT(anees(false), 2.5);
  const double known = anees(true);
  std::cout << "ANEES " << anees(false) << " without, " << known << " with\n";
  EXPECT_GT(known, 0.7);
  EXPECT_LT(known, 1.4);
}

}  // namespace
}  // namespace waymark::test
