// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "localization/filters/measurement.hpp"
#include "localization/line_of_sight.hpp"
#include "localization/slam/ekf_slam.hpp"
#include "localization/slam/existence_log_odds.hpp"
#include "localization/slam/signature.hpp"
#include "localization/slam/slam_relocalization.hpp"
#include "tests/localization/made_beacons.hpp"

namespace waymark::test {
using namespace localization;
namespace {

SlamOptions made_drive_options() {
  SlamOptions options;
  options.max_range = 12;
  options.nearest = 0.5;
  return options;
}

PoseEstimate known_pose(const Pose2& pose) {
  return {pose, Eigen::Matrix3d::Identity() * 1e-9};
}

// Two rounds of a circle without a map: the landmarks of the first round bound the errors of the second.
TEST(EkfSlam, ASecondRoundIsBoundedByTheFirst) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    MadeDrive drive(seed, 60, false);
    PoseEstimate start{drive.truth(), Eigen::Matrix3d::Identity() * 1e-6};
    EkfSlam slam(start, made_drive_options());
    DeadReckoning odometry(start);
    for (int i = 0; i < 250; ++i) {
      const BodyMotion step = drive.drive();
      slam.predict(step);
      odometry.predict(step);
      slam.update(drive.look());
      ASSERT_TRUE(slam.estimate().pose.finite());
      ASSERT_TRUE(slam.estimate().covariance.allFinite());
    }
    EXPECT_LT((slam.estimate().pose.at() - drive.truth().at()).norm(), 1) << "seed " << seed;
    EXPECT_LT(slam.estimate().covariance(0, 0), 0.3 * odometry.estimate().covariance(0, 0));
    EXPECT_GT(slam.landmarks().size(), 5u);
    EXPECT_LT(slam.landmarks().size(), 75u) << "60 there are";
  }
}

// The slow twin is the same filter with everything always active: the full one.
TEST(SlamState, CompressedAndFullFilterAgree) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    MadeDrive a(seed, 60), b(seed, 60);
    SlamOptions near = made_drive_options(), whole = made_drive_options();
    near.margin = 2;
    whole.margin = 1e6;
    EkfSlam fast(known_pose(a.truth()), near), slow(known_pose(b.truth()), whole);
    for (int i = 0; i < 200; ++i) {
      fast.predict(a.drive());
      slow.predict(b.drive());
      fast.update(a.look());
      slow.update(b.look());
      ASSERT_LT((fast.estimate().pose.vector() - slow.estimate().pose.vector()).norm(), 1e-7) << i;
      ASSERT_TRUE(fast.estimate().covariance.isApprox(slow.estimate().covariance, 1e-6)) << i;
    }
    const auto x = fast.landmarks(), y = slow.landmarks();
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_LT((x[i].at - y[i].at).norm(), 1e-7);
      EXPECT_TRUE(x[i].covariance.isApprox(y[i].covariance, 1e-6));
    }
  }
}

// Covariance of a new landmark against numeric derivatives.
TEST(SlamState, ANewLandmarkHasItsMeasuredCovariance) {
  PoseEstimate robot{{1, 2, 0.7}, Eigen::Matrix3d::Identity()};
  robot.covariance << 0.04, 0.01, 0.002, 0.01, 0.09, -0.001, 0.002, -0.001, 0.001;
  const Pose2 mount{0.5, 0.1, -0.2};
  const auto place = [&](const Eigen::Vector3d& pose, double range, double bearing) -> Eigen::Vector2d {
    const Pose2 sensor = pose_of(pose) * mount;
    return sensor.at() +
           range * Eigen::Vector2d(std::cos(sensor.yaw + bearing), std::sin(sensor.yaw + bearing));
  };
  Eigen::Matrix<double, 2, 5> j;
  for (int i = 0; i < 5; ++i) {
    Eigen::Matrix<double, 5, 1> up, down;
    up << robot.pose.vector(), 8, 0.3;
    down = up;
    up[i] += 1e-6, down[i] -= 1e-6;
    j.col(i) = (place(up.head<3>(), up[3], up[4]) - place(down.head<3>(), down[3], down[4])) / 2e-6;
  }
  Eigen::Matrix<double, 5, 5> noise = Eigen::Matrix<double, 5, 5>::Zero();
  noise.topLeftCorner<3, 3>() = robot.covariance;
  noise(3, 3) = 0.01, noise(4, 4) = 0.0004;
  EkfSlam slam(robot, made_drive_options());
  SeenLandmark seen;
  seen.range = 8, seen.range_sd = 0.1, seen.bearing = 0.3, seen.bearing_sd = 0.02;
  slam.update({mount, {seen}});
  const auto all = slam.landmarks();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(all[0].covariance.isApprox(j * noise * j.transpose(), 1e-5));
  EXPECT_LT((all[0].at - place(robot.pose.vector(), 8, 0.3)).norm(), 1e-9);
}

// NEES of the robot over drives that began without a map: consistent is 1; an EKF that linearises is a little
// above (Bailey et al. 2006).
TEST(EkfSlam, ItsCovarianceIsThatOfItsErrors) {
  const double sum =
      mean_nees([](std::uint64_t seed) { return MadeDrive(seed, 60); },
                [](const Pose2& start) { return EkfSlam(known_pose(start), made_drive_options()); });
  EXPECT_GT(sum, 0.75);
  EXPECT_LT(sum, 1.4);
}

TEST(SlamState, StaysSymmetricAndPositiveDefiniteForLong) {
  MadeDrive drive(9, 60);
  SlamState state(known_pose(drive.truth()));
  std::vector<SlamState::Slot> slot_of(100, SlamState::Slot(-1));
  for (int i = 0; i < 4000; ++i) {
    state.predict(drive.drive());
    if (i % 20 == 0) state.focus(25);  // 12 m are seen, 10 m driven until the next
    std::vector<SlamState::Correction> corrections;
    for (const SeenLandmark& s : drive.look().sightings) {
      SlamState::Slot& slot = slot_of[*s.identity];
      if (slot == SlamState::Slot(-1)) {
        slot =
            state.add(state.pose().at() + *s.range * Eigen::Vector2d(std::cos(*s.bearing + state.pose().yaw),
                                                                     std::sin(*s.bearing + state.pose().yaw)),
                      Eigen::Matrix2d::Identity() * 25);
      }
      const ExpectedSighting e = expect(state.pose(), {}, state.at(slot));
      corrections.push_back({slot, innovation(s, e.value), e.by_pose, e.by_landmark, sensor_noise(s)});
    }
    state.update(corrections);
  }
  std::vector<SlamState::Slot> order;
  const Eigen::MatrixXd all = state.full_covariance(order);
  EXPECT_GT(order.size(), 20u);
  EXPECT_LT((all - all.transpose()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(all).info(), Eigen::Success);
}

LandmarkGrid grid_of(std::vector<MapLandmark> map, double quality = 0.9) {
  for (MapLandmark& l : map) l.quality = quality;
  return LandmarkGrid(std::move(map));
}

TEST(EkfSlam, AMapBoundsErrorsFromTheStart) {
  double with = 0, without = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    MadeDrive drive(seed, 60, false);
    const PoseEstimate start = drive.start();
    EkfSlam mapped(start, grid_of(drive.map()), {}, made_drive_options()), alone(start, made_drive_options());
    for (int i = 0; i < 120; ++i) {
      const BodyMotion step = drive.drive();
      const SightingSet seen = drive.look();
      mapped.predict(step), alone.predict(step);
      mapped.update(seen), alone.update(seen);
    }
    with += (mapped.estimate().pose.at() - drive.truth().at()).norm() / 5;
    without += (alone.estimate().pose.at() - drive.truth().at()).norm() / 5;
    for (const SlamLandmark& l : mapped.landmarks()) {
      if (l.matches <= 5 || !l.was_mapped) continue;
      EXPECT_LT(l.covariance(0, 0), 0.02 * 0.02) << "better than the map's";
    }
  }
  EXPECT_LT(with, 0.1);
  EXPECT_LT(with, without);
}

TEST(EkfSlam, WhatIsNotThereLosesItsExistenceAndALowQualityDiesFirst) {
  MadeDrive drive(4, 60, false);
  std::vector<MapLandmark> map = drive.map();
  // Two that are not there, ahead of the robot on its circle.
  MapLandmark good, poor;
  good.key = 1001, good.quality = 0.99, poor.key = 1002, poor.quality = 0.5;
  good.covariance = poor.covariance = Eigen::Matrix2d::Identity() * 1e-4;
  const Pose2 ahead = drive.truth() * Pose2{4, 0.7, 0};
  good.at = ahead.at(), poor.at = (drive.truth() * Pose2{4, -0.7, 0}).at();
  for (MapLandmark& l : map) l.quality = 0.9;
  std::erase_if(map, [&](const MapLandmark& l) { return (l.at - ahead.at()).norm() < 2; });
  map.push_back(good), map.push_back(poor);
  EkfSlam slam(known_pose(drive.truth()), LandmarkGrid(map), {}, made_drive_options());
  double good_odds = 0, poor_odds = 0;
  for (int i = 0; i < 8; ++i) {
    slam.predict(drive.drive(0.2));
    slam.update(drive.look());
    if (i != 5) continue;
    for (const SlamLandmark& l : slam.landmarks()) {
      if (l.key == 1001u) good_odds = l.log_odds;
      if (l.key == 1002u) poor_odds = l.gone ? -10 : l.log_odds;
    }
  }
  EXPECT_LT(good_odds, log_odds(0.99));
  EXPECT_LT(poor_odds, good_odds);
}

TEST(EkfSlam, LandmarksHiddenByTerrainAreNotExpected) {
  MadeDrive a(4, 60, false), b(4, 60, false);
  std::vector<MapLandmark> map = a.map();
  MapLandmark hidden;
  hidden.key = 1001;
  hidden.covariance = Eigen::Matrix2d::Identity() * 1e-4;
  hidden.at = (a.truth() * Pose2{5, 0.5, 0}).at();
  map.push_back(hidden);
  EkfSlam open(known_pose(a.truth()), grid_of(map), {}, made_drive_options());
  EkfSlam hilly(known_pose(b.truth()), grid_of(map), {}, made_drive_options(),
                [&](const Pose2&, const Eigen::Vector2d& at) { return (at - hidden.at).norm() > 0.1; });
  for (int i = 0; i < 20; ++i) {  // 4 m: looks from one place are one view
    open.predict(a.drive(0.2)), hilly.predict(b.drive(0.2));
    open.update(a.look()), hilly.update(b.look());
  }
  const auto odds = [](EkfSlam& slam) {
    for (const SlamLandmark& l : slam.landmarks())
      if (l.key == 1001u) return l.log_odds;
    return std::nan("");
  };
  EXPECT_DOUBLE_EQ(odds(hilly), log_odds(0.9));
  EXPECT_LT(odds(open), log_odds(0.9) - 0.3);
}

// Filters would leave it out beside likely ones; then it would count as missing, and start again as another.
TEST(EkfSlam, ADoubtfulLandmarkThatIsSeenIsConfirmed) {
  MapLandmark doubtful = landmark_at(5, 0, 3);
  doubtful.quality = 0.3;
  std::vector<MapLandmark> map{landmark_at(4, 3, 1), landmark_at(4, -3, 2), doubtful};
  for (MapLandmark& l : map) l.covariance = Eigen::Matrix2d::Identity() * 1e-4;
  EkfSlam slam(known_pose({}), LandmarkGrid(map), {}, made_drive_options());
  const double aside = std::atan2(3, 4);
  for (int i = 0; i < 10; ++i) slam.update({{}, {seen_at(5, aside), seen_at(5, -aside), seen_at(5, 0)}});
  ASSERT_EQ(slam.landmarks().size(), 3u);
  for (const SlamLandmark& l : slam.landmarks()) {
    EXPECT_GT(l.matches, 0) << l.key.value_or(0);
    if (l.key == 3u) {
      EXPECT_GT(l.log_odds, log_odds(0.3));
    }
  }
}

// Something stands before a landmark 4 m ahead that the filter found, or it is gone; two others stay in
// sight.
TEST(EkfSlam, WithoutAMapWhatBeamsDoNotReachIsNotExpected) {
  const auto count_landmarks = [](const LandmarkGrid& map, float ahead) {
    EkfSlam slam(known_pose({}), map, {}, made_drive_options());
    SightingSet seen{{}, {seen_at(8, 0.5), seen_at(8, -0.5), seen_at(4, 0)}};
    for (int i = 0; i < 20; ++i) slam.update(seen);
    seen.sightings.pop_back();
    RangeProfile beams{-1, 0.05, std::vector<float>(41, 0)};
    for (int i = -2; i <= 2; ++i) beams.ranges[static_cast<std::size_t>(20 + i)] = ahead;
    seen.ranges = std::make_shared<const RangeProfile>(beams);
    for (int i = 0; i < 60; ++i) slam.update(seen);
    return slam.landmarks().size();
  };
  EXPECT_EQ(count_landmarks({}, 2), 3u);
  EXPECT_EQ(count_landmarks({}, 9), 2u);
  EXPECT_EQ(count_landmarks({}, 0), 2u);  // no return
  EXPECT_EQ(count_landmarks(LandmarkGrid({landmark_at(-50, 0, 1)}), 2), 2u + 1);
}

TEST(EkfSlam, SignaturesKeepNeighboursApart) {
  TypeRegistry types;
  register_landmark_types(types);
  std::vector<MapLandmark> map(2);
  for (MapLandmark& l : map) {
    l.type = types.id("rock");
    l.covariance = Eigen::Matrix2d::Identity() * 0.25;
    l.features.variance[0] = 1e-4;
  }
  map[0].key = 1, map[0].at = {5, 0.3}, map[0].features.value[0] = 0.3;
  map[1].key = 2, map[1].at = {5, -0.3}, map[1].features.value[0] = 1.2;
  EkfSlam slam({{}, Eigen::Vector3d(0.09, 0.09, 1e-3).asDiagonal()}, LandmarkGrid(map), FeatureScales(types),
               made_drive_options());
  SeenLandmark seen;
  seen.type = types.id("rock");
  seen.range = 5, seen.bearing = 0;  // between the two
  seen.features.value[0] = 1.15, seen.features.variance[0] = 1e-3;
  EXPECT_EQ(slam.update({{}, {seen}}).at(0).key, 2u);
  seen.type = types.id("tree");
  EXPECT_NE(slam.update({{}, {seen}}).at(0).verdict, Verdict::matched) << "a tree is no rock";
}

// By default the existence of a landmark is its prior and does not widen the noise; with quality=paper eq. 8
// does.
TEST(EkfSlam, OnlyThePapersQualityWidensTheNoise) {
  MapLandmark rock = landmark_at(5, 0, 1);
  rock.covariance = Eigen::Matrix2d::Identity() * 1e-4;
  const auto variance = [&](double existence, double paper_quality, const std::string& use) {
    rock.quality = existence, rock.paper_quality = paper_quality;
    SlamOptions options = made_drive_options();
    options.identification.quality = use;
    SeenLandmark seen = seen_at(5, 0);
    seen.identity = 1;
    EkfSlam slam({{}, Eigen::Vector3d(0.04, 0.04, 1e-3).asDiagonal()}, LandmarkGrid({rock}), {}, options);
    EXPECT_EQ(slam.update({{}, {seen}}).at(0).key, 1u);
    return slam.estimate().covariance(0, 0);
  };
  const double sure = variance(1, 1, "existence");
  EXPECT_DOUBLE_EQ(variance(0.7, 1, "existence"), sure);
  EXPECT_DOUBLE_EQ(variance(1, 0.3, "existence"), sure);
  EXPECT_GT(variance(1, 0.3, "paper"), 1.5 * sure);
}

// Two rocks of the map fit after a gap, the nearer one a little better. The choice would not be revised.
TEST(EkfSlam, APairThatAnotherLandmarkCouldReplaceIsNotUsed) {
  const LandmarkGrid map({landmark_at(10, 0.4, 1), landmark_at(10, -0.6, 2)});
  const SightingSet seen{{}, {seen_at(10, 0)}};
  EkfSlam unsure({{}, Eigen::Vector3d(1, 1, 1e-2).asDiagonal()}, map, {}, made_drive_options());
  EXPECT_NE(unsure.update(seen).at(0).verdict, Verdict::matched);
  EkfSlam sure({{0, 0.4, 0}, Eigen::Vector3d(1e-3, 1e-3, 1e-6).asDiagonal()}, map, {}, made_drive_options());
  EXPECT_EQ(sure.update(seen).at(0).key, 1u);
}

TEST(Signature, MergingWeighsByVariance) {
  KnownFeatures known, seen;
  seen.value[0] = 1, seen.variance[0] = 0.01;
  merge_signature({}, 0, known, seen, 0.1);
  EXPECT_DOUBLE_EQ(known.value[0], 1);
  seen.value[0] = 2, seen.variance[0] = 0.04;
  merge_signature({}, 0, known, seen, 0.1);
  EXPECT_NEAR(known.value[0], 1 + 0.01 / (0.01 + 0.04), 1e-12);
  EXPECT_FALSE(known.known(1)) << "an unseen feature stays unknown";
}

TEST(Existence, CountersTurnIntoProbabilities) {
  EXPECT_NEAR(probability_from_log_odds(log_odds(0.8)), 0.8, 1e-12);
  EXPECT_DOUBLE_EQ(log_odds(1), kSurestLogOdds);
  EXPECT_DOUBLE_EQ(unseen_evidence(0.9, -0.5), -0.5);
  EXPECT_NEAR(unseen_evidence(0.1, -0.5), std::log(0.9), 1e-12) << "a sensor that misses much says little";
}

TEST(PoseTrial, OnlySightingsThatOnePoseExplainsDecide) {
  PoseTrial trial;
  trial.add(true, true), trial.add(false, false);
  EXPECT_DOUBLE_EQ(trial.chance_of_rival(), 1);
  for (int i = 0; i < 3; ++i) trial.add(false, true);
  EXPECT_DOUBLE_EQ(trial.chance_of_rival(), 1.0 / 8);
  EXPECT_DOUBLE_EQ(trial.chance_of_own(), 1);
  trial.add(true, false);  // three of four: (4 + 1) / 16
  EXPECT_DOUBLE_EQ(trial.chance_of_rival(), 5.0 / 16);
  EXPECT_DOUBLE_EQ(trial.chance_of_own(), 15.0 / 16);
}

/// A finder that answers with the truth moved by `offset`.
PoseFinder finder_at(const MadeDrive& drive, const Pose2& offset, int& calls) {
  return [&drive, offset, &calls](const SightingSet&) {
    ++calls;
    PoseSearchResult found;
    found.accepted = PoseEstimate{drive.truth() * offset, Eigen::Vector3d(0.01, 0.01, 0.0004).asDiagonal()};
    return found;
  };
}

TEST(EkfSlam, AWrongAnswerOfTheFinderDoesNotMoveIt) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    MadeDrive drive(seed, 60, false);
    EkfSlam slam(drive.start(), grid_of(drive.map()), {}, made_drive_options());
    int calls = 0;
    slam.set_pose_finder(finder_at(drive, {1.6, 0.5, 0.05}, calls));
    for (int i = 0; i < 120; ++i) {
      slam.predict(drive.drive());
      slam.update(drive.look());
      EXPECT_LT((slam.estimate().pose.at() - drive.truth().at()).norm(), 0.5) << seed << ", set " << i;
      EXPECT_EQ(slam.status(), LocalizationStatus::tracking) << seed << ", set " << i;
    }
    EXPECT_GE(calls, 2);
    EXPECT_EQ(slam.restarts(), 0) << seed;
  }
}

TEST(EkfSlam, ARightAnswerMovesALostFilter) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    MadeDrive drive(seed, 60, false);
    PoseEstimate start = drive.start();
    start.pose = start.pose * Pose2{9, 4, 0.8};
    EkfSlam slam(start, grid_of(drive.map()), {}, made_drive_options());
    int calls = 0;
    slam.set_pose_finder(finder_at(drive, {}, calls));
    for (int i = 0; i < 120; ++i) {
      slam.predict(drive.drive());
      slam.update(drive.look());
    }
    EXPECT_EQ(slam.restarts(), 1) << seed;
    EXPECT_EQ(slam.status(), LocalizationStatus::tracking) << seed;
    EXPECT_LT((slam.estimate().pose.at() - drive.truth().at()).norm(), 0.3) << seed;
  }
}

TEST(EkfSlam, ACheckedPoseIsNotSearchedInTheWholeMap) {
  for (const bool confirmed : {true, false}) {
    MadeDrive drive(1, 60, false);
    EkfSlam slam(drive.start(), grid_of(drive.map()), {}, made_drive_options());
    int calls = 0, checks = 0;
    slam.set_pose_finder(finder_at(drive, {}, calls), [&](const SightingSet&, const PoseEstimate& expected) {
      ++checks;
      return confirmed ? std::optional(expected) : std::nullopt;
    });
    for (int i = 0; i < 100; ++i) {
      slam.predict(drive.drive());
      slam.update(drive.look());
    }
    EXPECT_GE(checks, 5);
    if (confirmed)
      EXPECT_EQ(calls, 0);
    else
      EXPECT_GE(calls, 5);
  }
}

TEST(EkfSlam, RangesCorrectByLandmarksOfTheMapAndStartNone) {
  double sum = 0;
  int rows = 0;
  for (std::uint64_t seed = 101; seed <= 110; ++seed) {
    BeaconDrive drive(seed, {.mount = {0.8, -0.5, 1.2}, .map_sd = 0.1});
    const PoseEstimate start = drive.start();
    EkfSlam slam(start, LandmarkGrid(drive.map()), {});
    std::size_t strangers = 0;
    for (int i = 0; i < 400; ++i) {
      slam.predict(drive.drive());
      SightingSet seen = drive.look();
      SeenLandmark stranger;
      stranger.range = 12, stranger.identity = 99;
      seen.sightings.push_back(stranger);
      EXPECT_EQ(slam.update(seen).back().verdict, Verdict::nothing_near);
      EXPECT_EQ(slam.unplaced_ranges(), ++strangers);
      if (i < 20) continue;
      sum += nees(slam.estimate(), drive.truth()) / 3, ++rows;
    }
    EXPECT_LT((slam.estimate().pose.at() - drive.truth().at()).norm(), 0.5) << "seed " << seed;
    EXPECT_EQ(slam.landmarks().size(), drive.map().size());
  }
  std::printf("slam by ranges: anees %.2f\n", sum / rows);
  EXPECT_GT(sum / rows, 0.6);
  EXPECT_LT(sum / rows, 1.6);
}

// Fixes correct the landmarks as well: what was mapped with a wrong pose moves with it.
TEST(EkfSlam, FixesCorrectPoseAndLandmarks) {
  EkfSlam slam({{2, 0, 0}, Eigen::Vector3d(4, 4, 1e-6).asDiagonal()}, made_drive_options());
  slam.update({{}, {seen_at(5, 0)}});
  ASSERT_EQ(slam.landmarks().size(), 1u);
  EXPECT_NEAR(slam.landmarks()[0].at.x(), 7, 1e-9);
  EXPECT_TRUE(slam.fix(GnssFix{{0, 0}, 0.1}));
  EXPECT_NEAR(slam.estimate().pose.x, 0, 0.01);
  EXPECT_NEAR(slam.landmarks()[0].at.x(), 5, 0.01);
  EXPECT_LT(slam.landmarks()[0].covariance(0, 0), 0.03);
}

TEST(EkfSlam, AWildFixIsRefusedAndManyThatAgreeAreBelieved) {
  EkfSlam slam(known_pose({}), made_drive_options());
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(slam.fix(GnssFix{{500, 0}, 1})) << i;
  EXPECT_NEAR(slam.estimate().pose.x, 0, 1e-3);
  EXPECT_TRUE(slam.fix(GnssFix{{500, 0}, 1}));
  EXPECT_NEAR(slam.estimate().pose.x, 500, 10);
  EXPECT_TRUE(slam.estimate().covariance.allFinite());
  EXPECT_TRUE(slam.fix(HeadingFix{slam.estimate().pose.yaw + 0.1, 0.05}));
}

TEST(EkfSlam, NonsenseIsRefusedAndLeavesItAlone) {
  EkfSlam slam(known_pose({}), made_drive_options());
  SeenLandmark bad;
  bad.range = std::nan(""), bad.bearing = 0;
  SeenLandmark infinite = bad, far = bad;
  infinite.range = 3, infinite.bearing = INFINITY;
  far.range = 500;
  const auto m = slam.update({{}, {bad, infinite, far}});
  EXPECT_EQ(m[0].verdict, Verdict::unsound);
  EXPECT_EQ(m[1].verdict, Verdict::unsound);
  EXPECT_EQ(m[2].verdict, Verdict::too_far);
  EXPECT_TRUE(slam.estimate().covariance.allFinite());
  EXPECT_TRUE(slam.landmarks().empty());
}

}  // namespace
}  // namespace waymark::test
