// SPDX-License-Identifier: Apache-2.0
// Ranges without bearings.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>

#include "localization/filters/kalman.hpp"
#include "localization/filters/locating_filter.hpp"
#include "localization/filters/map_errors.hpp"
#include "localization/filters/measurement.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/filters/sighting_score.hpp"
#include "localization/global/range_resection.hpp"
#include "localization/identification/identification.hpp"
#include "tests/localization/made_beacons.hpp"

namespace waymark::test {
using namespace localization;
namespace {

SeenLandmark range_of(double range, double sd = 0.2) {
  SeenLandmark s;
  s.range = range, s.range_sd = sd;
  return s;
}

LandmarkMatcher matcher_of(const std::vector<MapLandmark>& map) {
  return LandmarkMatcher(LandmarkWindow{LandmarkGrid(map)});
}

using MakeRangeFilter =
    std::function<std::unique_ptr<Localizer>(const PoseEstimate& start, const std::vector<MapLandmark>& map)>;

std::unique_ptr<Localizer> ekf_of_ranges(const PoseEstimate& start, const std::vector<MapLandmark>& map) {
  return std::make_unique<ExtendedKalman>(start, matcher_of(map));
}
std::unique_ptr<Localizer> ukf_of_ranges(const PoseEstimate& start, const std::vector<MapLandmark>& map) {
  return std::make_unique<UnscentedKalman>(start, matcher_of(map));
}
std::unique_ptr<Localizer> particles_of_ranges(const PoseEstimate& start,
                                               const std::vector<MapLandmark>& map) {
  return std::make_unique<ParticleFilter>(start, matcher_of(map));
}
std::unique_ptr<Localizer> gaussians_of_ranges(const PoseEstimate& start,
                                               const std::vector<MapLandmark>& map) {
  IdentificationOptions options;
  options.use_identities = false;
  return std::make_unique<MultiHypothesisFilter>(
      start, LandmarkMatcher(LandmarkWindow{LandmarkGrid(map)}, {}, options));
}

struct RangeScore {
  double rmse = 0, anees = 0, matched = 0, wrong = 0;
};

/// Drives 200 steps, two rounds, per seed.
RangeScore drive_by_ranges(const MakeRangeFilter& make, const BeaconSettings& settings, std::uint64_t first,
                           int seeds) {
  double squares = 0, sum = 0, seen = 0, matched = 0, wrong = 0;
  int rows = 0;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(seeds); ++seed) {
    BeaconSettings named = settings;
    named.named = true;
    BeaconDrive drive(seed, named);
    const auto filter = make(drive.start(), drive.map());
    for (int i = 0; i < 400; ++i) {
      filter->predict(drive.drive());
      const SightingSet set = drive.look();
      SightingSet shown = set;
      if (!settings.named)
        for (SeenLandmark& s : shown.sightings) s.identity.reset();
      const std::vector<Match> matches = filter->update(shown);
      for (std::size_t k = 0; k < matches.size(); ++k) {
        ++seen;
        if (matches[k].verdict != Verdict::matched) continue;
        ++matched, wrong += matches[k].key != *set.sightings[k].identity;
      }
      if (i < 20) continue;
      squares += (filter->estimate().pose.at() - drive.truth().at()).squaredNorm();
      sum += nees(filter->estimate(), drive.truth()) / 3, ++rows;
    }
  }
  return {std::sqrt(squares / rows), sum / rows, matched / seen, wrong / std::max(1.0, matched)};
}

TEST(Ranges, CurvatureIsThatOfManyPoses) {
  for (const double range : {4.0, 12.0}) {
    Random random(1, "curvature");
    const PoseEstimate robot{{1, 2, 0.5}, Eigen::Vector3d(0.5, 0.3, 0.01).asDiagonal()};
    const Pose2 mount{0.4, -0.3, 1};
    const Eigen::Vector2d landmark = (robot.pose * mount).at() + range * Eigen::Vector2d(0.6, -0.8);
    const SeenLandmark corrected = correct_curvature(range_of(range), robot, mount, landmark);
    const ExpectedSighting e = expect(robot.pose, mount, landmark);
    double mean = 0, square = 0;
    constexpr int kDraws = 200000;
    for (int i = 0; i < kDraws; ++i) {
      const Eigen::Vector3d off =
          robot.covariance.cwiseSqrt() * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
      const double drawn = expect(pose_of(robot.pose.vector() + off), mount, landmark).value[0];
      const double left = drawn - e.value[0] - e.by_pose.row(0).dot(off);  // beyond the linear part
      mean += left / kDraws, square += left * left / kDraws;
    }
    EXPECT_NEAR(range - *corrected.range, mean, 0.12 * mean + 1e-3) << range;
    const double variance = corrected.range_sd * corrected.range_sd - 0.04;
    EXPECT_NEAR(variance, square - mean * mean, 0.4 * variance) << range;
  }
  const SeenLandmark both = seen_at(5, 0.3);
  EXPECT_EQ(correct_curvature(both, {}, {}, {1, 2}).range, both.range);
}

// The slow twin: the Gaussian of draws from the two poses.
TEST(Ranges, AProbableCorrectionIsAMixture) {
  const PoseEstimate robot{{1, 2, 0.5}, Eigen::Vector3d(0.5, 0.3, 0.01).asDiagonal()};
  MapLandmark landmark = landmark_at(14, 5, 1);
  landmark.covariance = 0.04 * Eigen::Matrix2d::Identity();
  MapErrors sure, same, mixed;
  const PoseEstimate after = sure.correct(robot, range_of(14), {}, landmark, 1);
  EXPECT_EQ(same.correct_probably(robot, range_of(14), {}, landmark, 1, 1).covariance, after.covariance);
  const PoseEstimate both = mixed.correct_probably(robot, range_of(14), {}, landmark, 1, 0.7);
  const Eigen::Vector3d mean = 0.7 * after.pose.vector() + 0.3 * robot.pose.vector();
  Eigen::Matrix3d second = -mean * mean.transpose();
  second += 0.7 * (after.covariance + after.pose.vector() * after.pose.vector().transpose());
  second += 0.3 * (robot.covariance + robot.pose.vector() * robot.pose.vector().transpose());
  EXPECT_LT((both.pose.vector() - mean).norm(), 1e-12);
  EXPECT_LT((both.covariance - second).norm(), 1e-12);
}

// The slow twin: one row, without the code shared with bearings.
TEST(Ranges, UpdateIsThatOfOneRow) {
  Random random(2, "one row");
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::Matrix3d root;
    for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = 0.1 * random.normal();
    const PoseEstimate robot{{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-3, 3)},
                             root * root.transpose() + 1e-4 * Eigen::Matrix3d::Identity()};
    const Pose2 mount{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)};
    MapLandmark landmark = landmark_at(random.uniform(10, 20), random.uniform(-20, 20), 1);
    landmark.covariance << 0.02, 0.005, 0.005, 0.01;
    const auto range_at = [&](const Pose2& at, const Eigen::Vector2d& there) {
      return (there - (at * mount).at()).norm();
    };
    const SeenLandmark seen = range_of(range_at(robot.pose, landmark.at) + 0.3 * random.normal());
    const SeenLandmark flat = correct_curvature(seen, robot, mount, landmark.at);
    Eigen::RowVector3d h;
    Eigen::RowVector2d b;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = 1e-6 * Eigen::Vector3d::Unit(i);
      h[i] = (range_at(pose_of(robot.pose.vector() + d), landmark.at) -
              range_at(pose_of(robot.pose.vector() - d), landmark.at)) /
             2e-6;
    }
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d d = 1e-6 * Eigen::Vector2d::Unit(i);
      b[i] = (range_at(robot.pose, landmark.at + d) - range_at(robot.pose, landmark.at - d)) / 2e-6;
    }
    const double s = h * robot.covariance * h.transpose() + (b * landmark.covariance * b.transpose())(0) +
                     flat.range_sd * flat.range_sd;
    const Eigen::Vector3d gain = robot.covariance * h.transpose() / s;
    const Pose2 pose =
        pose_of(robot.pose.vector() + gain * (*flat.range - range_at(robot.pose, landmark.at)));
    const Eigen::Matrix3d covariance = robot.covariance - gain * s * gain.transpose();
    MapErrors errors;
    for (const PoseEstimate& after :
         {ekf_update(robot, seen, mount, landmark), errors.correct(robot, seen, mount, landmark, 1)}) {
      EXPECT_LT((after.pose.vector() - pose.vector()).norm(), 1e-6) << trial;
      EXPECT_LT((after.covariance - covariance).norm(), 1e-6) << trial;
    }
    const JointEvidence evidence =
        evidence_of(flat, expect(robot.pose, mount, landmark.at), landmark.covariance);
    EXPECT_EQ(evidence.rows, 1);
    EXPECT_LT((update_pose(robot, evidence).covariance - covariance).norm(), 1e-6) << trial;
    EXPECT_NEAR(joint_distance(evidence, robot.covariance).log_det, std::log(s), 1e-5) << trial;
  }
}

TEST(Ranges, ScoreIsTheDensityOfTheNearestRing) {
  Random random(3);
  const auto all = scatter_landmarks(40, 20, 2, 0.1);
  const LandmarkGrid map(all);
  const FeatureScales scales;
  WeightOptions options;
  options.temper = 1;
  const SightingSet seen{{0.3, 0.1, 0.2}, {range_of(4), range_of(6, 0.1)}};
  SightingScore score(seen, map, scales, options, {});
  std::vector<Pose2> poses;
  std::vector<double> expected;
  for (int i = 0; i < 200; ++i) {
    poses.push_back({random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-0.4, 0.4)});
    double sum = 0;
    for (const SeenLandmark& s : seen.sightings) {
      double best = 0;
      for (const MapLandmark& l : all) {
        const Eigen::Vector2d to = l.at - (poses[static_cast<std::size_t>(i)] * seen.robot_from_sensor).at();
        const double off = *s.range - to.norm(), variance = s.range_sd * s.range_sd + 0.01;
        if (off * off / variance > -2 * std::log1p(-options.gate)) continue;
        best =
            std::max(best, std::exp(-off * off / variance / 2) / std::sqrt(2 * std::numbers::pi * variance));
      }
      sum += std::log(IdentificationOptions{}.clutter * 2 * std::numbers::pi + best);
    }
    expected.push_back(sum);
    ASSERT_NEAR(score(poses.back()), sum, 1e-9) << i;
  }
  score.prefetch(poses);
  std::vector<double> together(poses.size());
  score(poses, together);
  for (std::size_t i = 0; i < poses.size(); ++i) ASSERT_NEAR(together[i], expected[i], 1e-9) << i;
}

TEST(Ranges, ARingThroughTwoLandmarksIsAmbiguous) {
  const PoseEstimate robot{{0, 0, 0.3}, Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal()};
  const LandmarkGrid both({landmark_at(10, 0, 1), landmark_at(0, -10, 2), landmark_at(3, 3, 3)});
  SightingSet seen{{}, {range_of(10)}};
  EXPECT_EQ(identify(seen, robot, both, {}, {}).matches[0].verdict, Verdict::ambiguous);
  const LandmarkGrid one({landmark_at(10, 0, 1), landmark_at(3, 3, 3)});
  const Match match = identify(seen, robot, one, {}, {}).matches[0];
  EXPECT_EQ(match.verdict, Verdict::matched);
  EXPECT_EQ(one[match.pairing.landmark].key, 1u);
  seen.sightings[0].identity = 2;
  const Match named = identify(seen, robot, both, {}, {}).matches[0];
  EXPECT_EQ(named.verdict, Verdict::matched);
  EXPECT_EQ(both[named.pairing.landmark].key, 2u);
  seen.sightings[0].range = 15;
  EXPECT_EQ(identify(seen, robot, both, {}, {}).matches[0].verdict, Verdict::too_far);
}

// Seeds 1 to 20 were looked at while this was written; these were not.
constexpr std::uint64_t kSeeds = 101;

TEST(Ranges, FiltersAreConsistentOnDrives) {
  const std::pair<const char*, MakeRangeFilter> filters[] = {{"ekf", ekf_of_ranges},
                                                             {"ukf", ukf_of_ranges},
                                                             {"particles", particles_of_ranges},
                                                             {"gaussians", gaussians_of_ranges}};
  const std::pair<const char*, BeaconSettings> cases[] = {{"plain", {}},
                                                          {"mount", {.mount = {0.8, -0.5, 1.2}}},
                                                          {"outliers", {.outliers = 0.1}},
                                                          {"poor map", {.map_sd = 0.15}},
                                                          {"poor start", {.start_sd = 2}},
                                                          {"unnamed", {.named = false}}};
  for (const auto& [what, settings] : cases)
    for (const auto& [name, make] : filters) {
      if ((name == std::string("gaussians")) == settings.named) continue;
      const RangeScore r = drive_by_ranges(make, settings, kSeeds, 10);
      std::printf("%-10s %-10s rmse %.3f m, anees %.2f, matched %.3f, wrong %.4f\n", what, name, r.rmse,
                  r.anees, r.matched, r.wrong);
      EXPECT_LT(r.rmse, settings.map_sd > 0.1 ? 0.32 : 0.2) << what << ' ' << name;
      EXPECT_LT(r.anees, 1.4) << what << ' ' << name;
      EXPECT_GT(r.anees, 0.6) << what << ' ' << name;
      EXPECT_LT(r.wrong, 0.01) << what << ' ' << name;
    }
}

/// A world turned and shifted.
TEST(Ranges, AnotherFrameChangesNothing) {
  const Pose2 frame{300, -120, 2.1};
  for (const MakeRangeFilter& make : {MakeRangeFilter(ekf_of_ranges), MakeRangeFilter(ukf_of_ranges)}) {
    BeaconDrive drive(5, {.mount = {0.5, 0.2, 1}});
    const PoseEstimate start = drive.start();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(frame.yaw).toRotationMatrix();
    std::vector<MapLandmark> turned = drive.map();
    for (MapLandmark& l : turned) {
      l.at = (frame * Pose2{l.at.x(), l.at.y(), 0}).at();
      l.covariance = turn.topLeftCorner<2, 2>() * l.covariance * turn.topLeftCorner<2, 2>().transpose();
    }
    const auto here = make(start, drive.map()),
               there = make({frame * start.pose, turn * start.covariance * turn.transpose()}, turned);
    for (int i = 0; i < 100; ++i) {
      const BodyMotion odometry = drive.drive();
      const SightingSet seen = drive.look();
      for (const auto& filter : {here.get(), there.get()}) filter->predict(odometry), filter->update(seen);
    }
    const PoseEstimate a = here->estimate(), b = there->estimate();
    const Pose2 expected = frame * a.pose;
    EXPECT_LT((expected.at() - b.pose.at()).norm(),
              0.02);  // the symmetric points of ukf follow the axes
    EXPECT_LT(std::abs(wrap_angle(expected.yaw - b.pose.yaw)), 2e-3);
  }
}

/// The particle filter without a start, as `pf` uses it.
TEST(Ranges, ParticlesFindTheRobotOrSayThatTheyAreLost) {
  for (const bool straight : {false, true}) {
    int found = 0, wrong = 0;
    double steps = 0;
    constexpr int kDrives = 20;
    for (std::uint64_t seed = 301; seed < 301 + kDrives; ++seed) {
      BeaconDrive drive(seed, {.beacons = straight ? 2u : 4u, .straight = straight});
      const LandmarkGrid map(drive.map());
      const PoseFinder finder = [&](const SightingSet& seen) { return resect(seen.earlier_ranges, map); };
      LocatingFilter filter(
          std::make_unique<ParticleFilter>(std::nullopt, matcher_of(drive.map()), ParticleOptions{}, finder),
          [&](const PoseEstimate& at) { return particles_of_ranges(at, drive.map()); });
      int since = 0;
      for (int i = 0; i < (straight ? 40 : 200); ++i) {
        filter.predict(drive.drive());
        filter.update(drive.look());
        if (filter.status() != LocalizationStatus::tracking) continue;
        if (!since) since = i + 1, ++found;
        wrong += (filter.estimate().pose.at() - drive.truth().at()).norm() > 2;
      }
      steps += since;
    }
    std::printf("%s: found %d of %d, after %.0f steps; wrong %d\n",
                straight ? "straight, two beacons" : "loop", found, kDrives, steps / std::max(1, found),
                wrong);
    EXPECT_EQ(wrong, 0);
    if (!straight) {
      EXPECT_EQ(found, kDrives);
    }
  }
}

}  // namespace
}  // namespace waymark::test
