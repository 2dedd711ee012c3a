// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/range_slam.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>

#include "localization/filters/kalman.hpp"
#include "tests/localization/made_beacons.hpp"

namespace waymark::test {
using namespace localization;
namespace {

/// Beacons that the filter knows: the first `count`.
std::vector<RangeBeacon> known_beacons(const BeaconDrive& drive, std::size_t count, bool with_heights) {
  std::vector<RangeBeacon> known;
  for (std::size_t i = 0; i < std::min(count, drive.map().size()); ++i)
    known.push_back({drive.map()[i].key, drive.map()[i].at, drive.map()[i].covariance,
                     with_heights ? drive.heights()[i] : 0});
  return known;
}

struct SlamScore {
  double rmse = 0, anees = 0;                // of the pose
  double beacon_rmse = 0, beacon_anees = 0;  // of new beacons at the end
  int placed = 0, misplaced = 0, open = 0;   // new ones; misplaced: off by more than 3 m
  std::vector<double> drives;                // ANEES of each
};

SlamScore slam_by_ranges(const BeaconSettings& settings, const RangeSlamOptions& options, std::size_t known,
                         std::uint64_t first, int seeds, bool with_heights = true) {
  SlamScore score;
  int rows = 0, counted = 0;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(seeds); ++seed) {
    BeaconDrive drive(seed, settings);
    RangeSlam slam(drive.start(), known_beacons(drive, known, with_heights), options);
    double sum = 0;
    int own = 0;
    for (int i = 0; i < 400; ++i) {
      slam.predict(drive.drive());
      slam.update(drive.look());
      if (i < 20) continue;
      score.rmse += (slam.estimate().pose.at() - drive.truth().at()).squaredNorm();
      sum += nees(slam.estimate(), drive.truth()) / 3, ++rows, ++own;
    }
    score.anees += sum;
    score.drives.push_back(sum / own);
    score.open += static_cast<int>(slam.open_beacons());
    for (const RangeSlam::Placed& b : slam.beacons())
      for (std::size_t i = known; i < drive.map().size(); ++i) {
        if (b.key != drive.map()[i].key) continue;
        const Eigen::Vector2d off = b.mean.head<2>() - drive.real()[i];
        ++score.placed;
        if (off.norm() > 3) {
          ++score.misplaced;
          continue;
        }
        score.beacon_rmse += off.squaredNorm();
        score.beacon_anees += off.dot(b.covariance.topLeftCorner<2, 2>().inverse() * off) / 2;
        ++counted;
      }
  }
  score.rmse = std::sqrt(score.rmse / rows), score.anees /= rows;
  score.beacon_rmse = std::sqrt(score.beacon_rmse / std::max(1, counted)),
  score.beacon_anees /= std::max(1, counted);
  return score;
}

SlamScore ekf_by_ranges(const BeaconSettings& settings, std::uint64_t first, int seeds) {
  SlamScore score;
  int rows = 0;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(seeds); ++seed) {
    BeaconDrive drive(seed, settings);
    ExtendedKalman filter(drive.start(), LandmarkMatcher(LandmarkWindow{LandmarkGrid(drive.map())}));
    for (int i = 0; i < 400; ++i) {
      filter.predict(drive.drive());
      filter.update(drive.look());
      if (i < 20) continue;
      score.rmse += (filter.estimate().pose.at() - drive.truth().at()).squaredNorm();
      score.anees += nees(filter.estimate(), drive.truth()) / 3, ++rows;
    }
  }
  score.rmse = std::sqrt(score.rmse / rows), score.anees /= rows;
  return score;
}

void report(const char* name, const SlamScore& s) {
  int in_band = 0;
  for (const double a : s.drives) in_band += a > 0.5 && a < 2;
  std::printf(
      "%s: RMSE %.3f m, ANEES %.2f (%d of %zu drives within 0.5 to 2); new beacons %d, misplaced %d, open "
      "%d, "
      "RMSE %.2f m, ANEES %.2f\n",
      name, s.rmse, s.anees, in_band, s.drives.size(), s.placed, s.misplaced, s.open, s.beacon_rmse,
      s.beacon_anees);
}

constexpr std::uint64_t kUnseen = 4501;  // seeds that nothing was chosen on
constexpr int kDrives = 20;

TEST(RangeSlam, KnownBeaconsAreAsGoodAsByTheFilter) {
  const SlamScore s = slam_by_ranges({}, {}, 4, kUnseen, kDrives), ekf = ekf_by_ranges({}, kUnseen, kDrives);
  report("known", s);
  report("known, ekf", ekf);
  EXPECT_LT(s.rmse, 1.05 * ekf.rmse);
  EXPECT_NEAR(s.anees, 1, 0.25);
}

TEST(RangeSlam, OffsetsAreEstimated) {
  const BeaconSettings settings{.offset_sd = 0.7};
  const SlamScore s = slam_by_ranges(settings, {.offset_sd = 0.7}, 4, kUnseen, kDrives);
  const SlamScore ekf = ekf_by_ranges(settings, kUnseen, kDrives);
  report("offsets of 0.7 m", s);
  report("offsets of 0.7 m, ekf", ekf);
  EXPECT_LT(s.rmse, 0.6 * ekf.rmse);
  EXPECT_NEAR(s.anees, 1, 0.35);
}

TEST(RangeSlam, SlantRangesToKnownHeights) {
  const BeaconSettings settings{.max_height = 12};
  const SlamScore s = slam_by_ranges(settings, {}, 4, kUnseen, kDrives);
  const SlamScore ekf = ekf_by_ranges(settings, kUnseen, kDrives);
  report("heights of 4 to 12 m", s);
  report("heights of 4 to 12 m, ekf", ekf);
  EXPECT_LT(s.rmse, 0.5 * ekf.rmse);
  EXPECT_NEAR(s.anees, 1, 0.3);
}

TEST(RangeSlam, UnknownBeaconsArePlaced) {
  const SlamScore two = slam_by_ranges({}, {}, 2, kUnseen, kDrives);
  const SlamScore none = slam_by_ranges({.start_sd = 0.05}, {}, 0, kUnseen, kDrives);
  report("two of four unknown", two);
  report("all unknown", none);
  EXPECT_GE(two.placed, 2 * kDrives - 2);
  EXPECT_EQ(two.misplaced, 0);
  EXPECT_GE(none.placed, 4 * kDrives - 6);
  EXPECT_LT(two.rmse, 0.25);
  EXPECT_LT(two.anees, 1.4);
  EXPECT_LT(two.beacon_anees, 2);
  // Without a beacon of the map the heading drifts before any is placed: the filter is then too certain.
  EXPECT_LT(none.rmse, 3);
}

TEST(RangeSlam, EchoesAreLeftOut) {
  const SlamScore s = slam_by_ranges({.outliers = 0.1}, {}, 2, kUnseen, kDrives);
  report("two unknown, one range in ten too long", s);
  EXPECT_LE(s.misplaced, 2);
  EXPECT_LT(s.rmse, 0.5);
}

// On a straight line both sides explain all ranges.
TEST(RangeSlam, MirroredPositionsStayOpen) {
  BeaconDrive drive(4100, {.straight = true});
  RangeSlam slam(drive.start(), known_beacons(drive, 0, false), {});
  for (int i = 0; i < 30; ++i) {
    slam.predict(drive.drive());
    slam.update(drive.look());
  }
  EXPECT_GE(slam.open_beacons(), 3u);
  for (const RangeSlam::Placed& b : slam.beacons())
    for (std::size_t i = 0; i < 4; ++i)
      if (b.key == drive.map()[i].key) {
        EXPECT_LT((b.mean.head<2>() - drive.real()[i]).norm(), 3);
      }
}

// The slow twin: one range by the formulas of a filter with one beacon, its derivative taken numerically.
TEST(RangeSlam, OneCorrectionIsThatOfAFilter) {
  const PoseEstimate robot{{1, 2, 0.5}, Eigen::Vector3d(1e-4, 2e-4, 1e-5).asDiagonal()};
  const Pose2 mount{0.4, -0.3, 0};
  const RangeBeacon beacon{
      .key = 7, .at = {9, -4}, .covariance = 4e-4 * Eigen::Matrix2d::Identity(), .height = 3};
  RangeSlam slam(robot, {beacon}, {.offset_sd = 0.05});
  const auto range = [&](const Eigen::Matrix<double, 6, 1>& x) {
    const Eigen::Vector2d sensor = (pose_of(x.head<3>()) * mount).at();
    return std::hypot((x.segment<2>(3) - sensor).norm(), beacon.height) + x[5];
  };
  Eigen::Matrix<double, 6, 1> mean, h;
  mean << robot.pose.vector(), beacon.at, 0;
  for (int k = 0; k < 6; ++k) {
    Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Zero();
    step[k] = 1e-6;
    h[k] = (range(mean + step) - range(mean - step)) / 2e-6;
  }
  Eigen::Matrix<double, 6, 6> p = Eigen::Matrix<double, 6, 6>::Zero();
  p.topLeftCorner<3, 3>() = robot.covariance;
  p.block<2, 2>(3, 3) = beacon.covariance;
  p(5, 5) = 0.0025;
  SeenLandmark seen;
  seen.range = range(mean) + 0.1, seen.range_sd = 0.2, seen.identity = 7;
  const Eigen::Matrix<double, 6, 1> gain = p * h / (h.dot(p * h) + 0.04);
  mean += gain * 0.1;
  p -= gain * h.transpose() * p;
  ASSERT_EQ(slam.update({mount, {seen}})[0].verdict, Verdict::matched);
  EXPECT_LT((slam.estimate().pose.vector() - mean.head<3>()).norm(), 1e-5);  // curvature of the circle
  EXPECT_LT((slam.estimate().covariance - p.topLeftCorner<3, 3>()).norm(), 1e-8);
  EXPECT_LT((slam.beacons()[0].mean - mean.tail<3>()).norm(), 1e-5);
  EXPECT_LT((slam.beacons()[0].covariance - p.bottomRightCorner<3, 3>()).norm(), 1e-7);
}

TEST(RangeSlam, FixesAndOtherSightings) {
  RangeSlam slam({{0, 0, 0}, Eigen::Vector3d(1, 1, 0.1).asDiagonal()}, {}, {});
  EXPECT_TRUE(slam.fix(GnssFix{{0.5, 0}, 1}));
  EXPECT_NEAR(slam.estimate().pose.x, 0.25, 1e-12);
  EXPECT_FALSE(slam.fix(GnssFix{{50, 0}, 1}));
  EXPECT_TRUE(slam.fix(HeadingFix{0.1, 0.3}));
  SeenLandmark bearing, nameless, broken;
  bearing.bearing = 0.2, bearing.identity = 3;
  nameless.range = 5;
  broken.range = -1, broken.identity = 3;
  const auto matches = slam.update({{}, {bearing, nameless, broken}});
  EXPECT_EQ(matches[0].verdict, Verdict::ambiguous);
  EXPECT_EQ(matches[1].verdict, Verdict::ambiguous);
  EXPECT_EQ(matches[2].verdict, Verdict::unsound);
  EXPECT_EQ(slam.open_beacons(), 0u);
}

}  // namespace
}  // namespace waymark::test
