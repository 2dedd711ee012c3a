// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <functional>

#include "localization/chi_square.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

IdentificationOptions identification_options(bool identities) {
  IdentificationOptions options;
  options.use_identities = identities;
  options.quality_floor = 1;
  return options;
}

using MakeOfDrive = std::function<std::unique_ptr<Localizer>(const PoseEstimate&, const MadeDrive&)>;

MakeOfDrive kalman(bool unscented) {
  return [unscented](const PoseEstimate& start, const MadeDrive& drive) -> std::unique_ptr<Localizer> {
    const LandmarkMatcher matcher(LandmarkWindow{LandmarkGrid(drive.map())}, {},
                                  identification_options(true));
    if (unscented) return std::make_unique<UnscentedKalman>(start, matcher);
    return std::make_unique<ExtendedKalman>(start, matcher);
  };
}

/// Tests the mean NEES at the end of many drives against the bounds of a consistent filter in 99.9 % of all
/// cases. One pose per drive counts: landmark errors are drawn once per drive, so poses of one drive are
/// correlated.
void expect_consistent(const MakeOfDrive& make, int runs, double slack) {
  double sum = 0;
  for (int run = 0; run < runs; ++run) {
    MadeDrive drive(static_cast<std::uint64_t>(run) + 1);
    const auto filter = make(drive.start(), drive);
    for (int i = 0; i < 20; ++i) {
      filter->predict(drive.drive());
      filter->update(drive.look());
    }
    sum += nees(filter->estimate(), drive.truth());
  }
  const double freedom = 3.0 * runs;
  EXPECT_GT(sum, chi_square_quantile(0.0005, freedom) / slack);
  EXPECT_LT(sum, chi_square_quantile(0.9995, freedom) * slack);
}

TEST(ExtendedKalman, IsConsistent) {
  expect_consistent(kalman(false), 100, 1.15);
}
TEST(UnscentedKalman, IsConsistent) {
  expect_consistent(kalman(true), 100, 1.15);
}

TEST(ExtendedKalman, JosephAndInformationFormsAgree) {
  MadeDrive drive(5);
  const SightingSet seen = drive.look();
  ASSERT_FALSE(seen.sightings.empty());
  const PoseEstimate start = drive.start();
  const MapLandmark& landmark = drive.map()[*seen.sightings[0].identity - 1];
  const PoseEstimate a = ekf_update(start, seen.sightings[0], {}, landmark);
  const PoseEstimate b = update_pose(
      start, evidence_of(seen.sightings[0], expect(start.pose, {}, landmark.at), landmark.covariance));
  EXPECT_LT((a.pose.vector() - b.pose.vector()).norm(), 1e-10);
  EXPECT_LT((a.covariance - b.covariance).norm(), 1e-10);
}

TEST(ExtendedKalman, CovarianceStaysPositiveForAMillionUpdates) {
  PoseEstimate e{{}, Eigen::Matrix3d::Identity()};
  MapLandmark landmark;
  landmark.at = {5, 1};
  SeenLandmark s;
  s.range = 5.1;
  s.range_sd = 1e-3;
  s.bearing = 0.2;
  s.bearing_sd = 1e-4;
  for (int i = 0; i < 1000000; ++i) e = ekf_update(e, s, {}, landmark);
  EXPECT_TRUE(e.covariance.allFinite());
  EXPECT_EQ(e.covariance, e.covariance.transpose());
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(e.covariance).eigenvalues().minCoeff(), 0);
}

TEST(ExtendedKalman, LowQualityWeighsLess) {
  MapLandmark good, poor;
  good.at = poor.at = {5, 0};
  poor.quality = 0.2;
  SeenLandmark s;
  s.range = 5.5;
  s.bearing = 0;
  const PoseEstimate start{{}, Eigen::Matrix3d::Identity() * 0.1};
  const double by_good = ekf_update(start, s, {}, good, good.quality).pose.x;
  const double by_poor = ekf_update(start, s, {}, poor, poor.quality).pose.x;
  EXPECT_LT(by_good, by_poor);
  EXPECT_LT(by_poor, 0);
}

TEST(ExtendedKalman, FindsBackAfterItWasMoved) {
  MadeDrive drive(7);
  PoseEstimate start = drive.start();
  start.pose.x += 6;  // 60 standard deviations off
  ExtendedKalman filter(
      start, LandmarkMatcher(LandmarkWindow{LandmarkGrid(drive.map())}, {}, identification_options(true)));
  bool was_lost = false;
  for (int i = 0; i < 60; ++i) {
    filter.predict(drive.drive());
    filter.update(drive.look());
    was_lost = was_lost || filter.status() == LocalizationStatus::lost;
    ASSERT_TRUE(filter.estimate().pose.finite());
  }
  EXPECT_TRUE(was_lost);
  EXPECT_EQ(filter.status(), LocalizationStatus::tracking);
  EXPECT_LT((filter.estimate().pose.at() - drive.truth().at()).norm(), 0.5);
}

TEST(MultiHypothesisFilter, FollowsLandmarksWithoutNames) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    MadeDrive drive(seed, 60, true);
    MultiHypothesisFilter filter(drive.start(), LandmarkMatcher(LandmarkWindow{LandmarkGrid(drive.map())}, {},
                                                                identification_options(false)));
    int matched = 0, wrong = 0;
    for (int i = 0; i < 60; ++i) {
      filter.predict(drive.drive());
      const SightingSet seen = drive.look();
      const auto matches = filter.update(seen);
      for (std::size_t k = 0; k < matches.size(); ++k) {
        if (matches[k].verdict != Verdict::matched) continue;
        ++matched;
        wrong += matches[k].key != *seen.sightings[k].identity;
      }
    }
    EXPECT_LT((filter.estimate().pose.at() - drive.truth().at()).norm(), 0.3) << "seed " << seed;
    EXPECT_GT(matched, 20) << "seed " << seed;
    EXPECT_LE(wrong, matched / 20) << "seed " << seed;
  }
}

// A few hundred particles, all but a handful lost at each update, would be overconfident.
TEST(ParticleFilter, AFewHundredAreConsistent) {
  double sum = 0;
  constexpr int kRuns = 60;
  for (int run = 0; run < kRuns; ++run) {
    MadeDrive drive(static_cast<std::uint64_t>(run) + 1);
    ParticleOptions options;
    options.particles = 300;
    options.weight.temper = 1;  // made errors are independent
    ParticleFilter filter(
        drive.start(),
        LandmarkMatcher(LandmarkWindow{LandmarkGrid(drive.map())}, {}, identification_options(true)),
        options);
    for (int i = 0; i < 20; ++i) {
      filter.predict(drive.drive());
      filter.update(drive.look());
    }
    sum += nees(filter.estimate(), drive.truth());
  }
  const double freedom = 3.0 * kRuns;
  EXPECT_GT(sum, chi_square_quantile(0.0005, freedom) / 1.15);
  EXPECT_LT(sum, chi_square_quantile(0.9995, freedom) * 1.15);
}

TEST(ParticleFilter, IsTheSameForAnyNumberOfThreads) {
  std::vector<Pose2> ends;
  for (const std::int64_t threads : {1, 2, 3}) {
    MadeDrive drive(3);
    ParticleOptions options;
    options.particles = 5000;
    options.threads = threads;
    ParticleFilter filter(
        drive.start(),
        LandmarkMatcher(LandmarkWindow{LandmarkGrid(drive.map())}, {}, identification_options(false)),
        options);
    for (int i = 0; i < 10; ++i) {
      filter.predict(drive.drive());
      filter.update(drive.look());
    }
    ends.push_back(filter.estimate().pose);
  }
  EXPECT_EQ(ends[0], ends[1]);
  EXPECT_EQ(ends[0], ends[2]);
}

TEST(ParticleFilter, FindsItsPoseWithoutAStart) {
  MadeDrive drive(11, 80, false);
  ParticleFilter filter(
      {}, LandmarkMatcher(LandmarkWindow{LandmarkGrid(drive.map())}, {}, identification_options(false)));
  EXPECT_EQ(filter.status(), LocalizationStatus::uninitialized);
  for (int i = 0; i < 80; ++i) {
    filter.predict(drive.drive());
    filter.update(drive.look());
    ASSERT_TRUE(filter.estimate().pose.finite());
  }
  EXPECT_LT((filter.estimate().pose.at() - drive.truth().at()).norm(), 0.5);
  // Without identities and without a finder nothing proves it.
  EXPECT_EQ(filter.status(), LocalizationStatus::lost);
}

TEST(ParticleFilter, PaperWeightsFollowToo) {
  MadeDrive drive(13);
  ParticleOptions options;
  options.weight.weights = "paper";
  ParticleFilter filter(
      drive.start(),
      LandmarkMatcher(LandmarkWindow{LandmarkGrid(drive.map())}, {}, identification_options(true)), options);
  for (int i = 0; i < 60; ++i) {
    filter.predict(drive.drive());
    filter.update(drive.look());
  }
  EXPECT_LT((filter.estimate().pose.at() - drive.truth().at()).norm(), 0.6);
}

TEST(ParticleFilter, EmptyMapAndEmptySetsLeaveTheEstimateFinite) {
  MadeDrive drive(1);
  for (const bool with_start : {false, true}) {
    ParticleFilter filter(with_start ? std::optional(drive.start()) : std::nullopt,
                          LandmarkMatcher(LandmarkWindow{LandmarkGrid{}}, {}, identification_options(false)));
    filter.predict(drive.drive());
    filter.update({});
    filter.update(drive.look());
    EXPECT_TRUE(filter.estimate().pose.finite());
    EXPECT_TRUE(filter.estimate().covariance.allFinite());
  }
}

TEST(AllFilters, NumbersThatAreNoneAreRejectedWithAReason) {
  MadeDrive drive(1);
  SightingSet bad;
  SeenLandmark s;
  s.range = NAN, s.bearing = 0;
  bad.sightings.push_back(s);
  s.range = 3;
  s.bearing_sd = 0;
  bad.sightings.push_back(s);
  s.bearing_sd = 0.1;
  s.range = -2;
  bad.sightings.push_back(s);
  const LandmarkMatcher matcher(LandmarkWindow{LandmarkGrid(drive.map())});
  std::vector<std::unique_ptr<Localizer>> all;
  all.push_back(std::make_unique<ExtendedKalman>(drive.start(), matcher));
  all.push_back(std::make_unique<UnscentedKalman>(drive.start(), matcher));
  all.push_back(std::make_unique<MultiHypothesisFilter>(drive.start(), matcher));
  all.push_back(std::make_unique<ParticleFilter>(drive.start(), matcher));
  for (const auto& filter : all) {
    const auto matches = filter->update(bad);
    ASSERT_EQ(matches.size(), 3u);
    for (const Match& match : matches) EXPECT_EQ(match.verdict, Verdict::unsound);
    EXPECT_TRUE(filter->estimate().pose.finite());
  }
  PoseEstimate nowhere = drive.start();
  nowhere.pose.x = NAN;
  EXPECT_THROW(ExtendedKalman(nowhere, matcher), std::invalid_argument);
  EXPECT_THROW(ParticleFilter(nowhere, matcher), std::invalid_argument);
}

}  // namespace
}  // namespace waymark::test
