// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/global/constellation.hpp"
#include "localization/global/sighting_memory.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

std::vector<std::unique_ptr<Localizer>> all_filters(const PoseEstimate& start, const LandmarkMatcher& map) {
  std::vector<std::unique_ptr<Localizer>> all;
  all.push_back(std::make_unique<ExtendedKalman>(start, map));
  all.push_back(std::make_unique<UnscentedKalman>(start, map));
  all.push_back(std::make_unique<MultiHypothesisFilter>(start, map));
  ParticleOptions options;
  options.particles = 2000;
  all.push_back(std::make_unique<ParticleFilter>(start, map, options));
  return all;
}

TEST(Fixes, PositionAndHeadingAreTheProductOfGaussians) {
  // 1 m known to 0.3 m, measured 1.6 m with 0.3 m: in the middle, with half the variance.
  const PoseEstimate start{{1, 0, 0}, Eigen::Vector3d(0.09, 0.09, 0.04).asDiagonal()};
  for (const auto& filter : all_filters(start, LandmarkMatcher(LandmarkWindow{LandmarkGrid{}}))) {
    EXPECT_TRUE(filter->fix(GnssFix{{1.6, 0}, 0.3}));
    EXPECT_NEAR(filter->estimate().pose.x, 1.3, 0.03);
    EXPECT_NEAR(filter->estimate().covariance(0, 0), 0.045, 0.006);
    EXPECT_TRUE(filter->fix(HeadingFix{0.2, 0.2}));
    EXPECT_NEAR(filter->estimate().pose.yaw, 0.1, 0.03);
    EXPECT_NEAR(filter->estimate().covariance(2, 2), 0.02, 0.005);
  }
}

TEST(Fixes, PositionsAreAsCertainAsTheirCovarianceInEachDirection) {
  // 1 m along the diagonal and 0.1 m across it; the pose is known to 1 m.
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(std::numbers::pi / 4).toRotationMatrix();
  const GnssFix fix =
      fix_of_covariance({1, -1}, turn * Eigen::Vector2d(1, 0.01).asDiagonal() * turn.transpose());
  EXPECT_NEAR(fix.sd, 1, 1e-12);
  const PoseEstimate start{{0, 0, 0}, Eigen::Vector3d(1, 1, 0.04).asDiagonal()};
  const Eigen::Vector2d across(std::sqrt(0.5), -std::sqrt(0.5)), along(std::sqrt(0.5), std::sqrt(0.5));
  for (const auto& filter : all_filters(start, LandmarkMatcher(LandmarkWindow{LandmarkGrid{}}))) {
    EXPECT_TRUE(filter->fix(fix));
    const PoseEstimate at = filter->estimate();
    const Eigen::Matrix2d covariance = at.covariance.topLeftCorner<2, 2>();
    EXPECT_NEAR(across.dot(at.pose.at()), std::sqrt(2.0) / 1.01, 0.05);
    EXPECT_NEAR(along.dot(at.pose.at()), 0, 0.1);
    EXPECT_NEAR(across.dot(covariance * across), 0.01 / 1.01, 0.004);
    EXPECT_NEAR(along.dot(covariance * along), 0.5, 0.1);
  }
}

TEST(Fixes, HeadingsWrap) {
  const PoseEstimate start{{0, 0, 3.1}, Eigen::Vector3d(1, 1, 0.01).asDiagonal()};
  for (const auto& filter : all_filters(start, LandmarkMatcher(LandmarkWindow{LandmarkGrid{}}))) {
    EXPECT_TRUE(filter->fix(HeadingFix{-3.1, 0.1}));
    EXPECT_NEAR(std::abs(filter->estimate().pose.yaw), std::numbers::pi, 0.03);
  }
}

TEST(Fixes, OneOutlierIsRejectedAndManyInARowAreAccepted) {
  const PoseEstimate start{{0, 0, 0}, Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal()};
  for (const auto& filter : all_filters(start, LandmarkMatcher(LandmarkWindow{LandmarkGrid{}}))) {
    EXPECT_FALSE(filter->fix(GnssFix{{500, 0}, 1}));
    EXPECT_NEAR(filter->estimate().pose.x, 0, 0.1);
    for (int i = 0; i < 12; ++i) filter->fix(GnssFix{{500, 0}, 1});
    EXPECT_NEAR(filter->estimate().pose.x, 500, 3);
    EXPECT_TRUE(filter->estimate().covariance.allFinite());
  }
}

// One fix that errs by 4.4 standard deviations makes the right hypothesis 1 : 20 000. It must survive until
// further sightings decide.
TEST(Fixes, AnImprobableHypothesisSurvivesUntilMoreIsSeen) {
  std::vector<MapLandmark> landmarks = scatter_landmarks(3, 10, 1, 0.001);
  landmarks[0].at = {5, 0};
  landmarks[1].at = {6.2, 0};
  landmarks[2].at = {0, 4};
  MultiHypothesisFilter filter({{0.6, 0, 0}, Eigen::Vector3d(0.25, 1e-4, 1e-6).asDiagonal()},
                               LandmarkMatcher(LandmarkWindow{LandmarkGrid(landmarks)}));
  SeenLandmark ahead;
  ahead.range = 5, ahead.bearing = 0;
  ahead.range_sd = 0.01;
  filter.update({{}, {ahead}});  // from 0 or from 1.2, or it was none of them
  filter.fix(GnssFix{{1.2, 0}, 0.27});
  SeenLandmark aside = ahead;
  aside.range = 4;
  aside.bearing = std::numbers::pi / 2;
  aside.bearing_sd = 0.005;
  for (int i = 0; i < 3; ++i) filter.update({{}, {aside}});  // from 0
  EXPECT_NEAR(filter.estimate().pose.x, 0, 0.05);
}

// Under trees GNSS errors last. Such fixes must not replace particles that match their sightings by
// particles of any heading 12 m away.
TEST(Fixes, CorrelatedFixesDoNotOverruleSightings) {
  MadeDrive drive(5, 60, false);
  IdentificationOptions identification;
  identification.use_identities = false;
  ParticleFilter filter(drive.start(),
                        LandmarkMatcher(LandmarkWindow{LandmarkGrid(drive.map())}, {}, identification));
  for (int i = 0; i < 60; ++i) {
    filter.predict(drive.drive());
    filter.update(drive.look());
    const double off = i < 10 ? 0 : 12;
    filter.fix(GnssFix{drive.truth().at() + Eigen::Vector2d(off, 0), 2});
    filter.fix(GnssFix{drive.truth().at() + Eigen::Vector2d(off, 0.1), 2});
    const PoseEstimate e = filter.estimate();
    const double sd = std::sqrt(std::max(e.covariance(0, 0), e.covariance(1, 1)));
    EXPECT_LT((e.pose.at() - drive.truth().at()).norm(), 0.3 + 3 * sd) << i;
  }
  filter.update(drive.look());
  EXPECT_LT((filter.estimate().pose.at() - drive.truth().at()).norm(), 0.5);
}

// The fixes win where the sightings fit no better at the old position.
TEST(Fixes, ManyFixesFindParticlesThatWereMoved) {
  MadeDrive drive(7, 80, false);
  IdentificationOptions identification;
  identification.use_identities = false;
  ParticleOptions options;
  options.search_particles = 20000;
  ParticleFilter filter(
      drive.start(), LandmarkMatcher(LandmarkWindow{LandmarkGrid(drive.map())}, {}, identification), options);
  for (int i = 0; i < 70; ++i) {
    const BodyMotion motion = drive.drive();
    if (i < 10 || i >= 20) filter.predict(motion);  // carried for 5 m
    filter.update(drive.look());
    filter.fix(GnssFix{drive.truth().at(), 0.5});
  }
  EXPECT_LT((filter.estimate().pose.at() - drive.truth().at()).norm(), 0.5);
}

TEST(ParticleFilter, BearingsAloneBoundTheError) {
  for (const bool particles : {false, true}) {
    MadeDrive drive(21);
    const LandmarkMatcher matcher(LandmarkWindow{LandmarkGrid(drive.map())});
    std::unique_ptr<Localizer> filter;
    if (particles)
      filter = std::make_unique<ParticleFilter>(drive.start(), matcher);
    else
      filter = std::make_unique<UnscentedKalman>(drive.start(), matcher);
    double drift = 0;
    DeadReckoning blind(drive.start());
    for (int i = 0; i < 80; ++i) {
      const BodyMotion motion = drive.drive();
      filter->predict(motion);
      blind.predict(motion);
      SightingSet seen = drive.look();
      for (SeenLandmark& s : seen.sightings) s.range.reset();
      filter->update(seen);
      drift = std::max(drift, (blind.estimate().pose.at() - drive.truth().at()).norm());
    }
    EXPECT_LT((filter->estimate().pose.at() - drive.truth().at()).norm(), 0.35) << particles;
    EXPECT_GT(drift, 0.5);
  }
}

// The slow twin: log of the probability of the missed detections, landmark by landmark.
TEST(SightingScore, UnseenLandmarksCountAgainstAPose) {
  auto landmarks = scatter_landmarks(200, 60, 3);
  Random random(1);
  for (MapLandmark& l : landmarks) l.quality = random.uniform(0.2, 1);
  const LandmarkGrid map(landmarks);
  const FeatureScales scales;
  WeightOptions options;
  options.temper = 1;
  SightingSet seen;
  SeenLandmark s;
  s.type = TypeId{0};
  s.range = 5;
  s.bearing = 0.3;
  seen.sightings.push_back(s);
  for (const double angle : {6.283185307179586, 2.0}) {
    options.view_range = 12;
    options.view_angle = angle;
    for (int i = 0; i < 50; ++i) {
      const Pose2 pose{random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-3, 3)};
      options.expect_unseen = false;
      const double plain = SightingScore(seen, map, scales, options, {})(pose);
      options.expect_unseen = true;
      const double full = SightingScore(seen, map, scales, options, {})(pose);
      double unseen = 0, matched = 0;
      const Eigen::Vector2d at = (pose * Pose2{5 * std::cos(0.3), 5 * std::sin(0.3), 0}).at();
      double nearest = 1e300;
      for (const MapLandmark& l : map.landmarks()) {
        if (l.outweighed) continue;  // not expected
        const Eigen::Vector2d d = l.at - pose.at();
        const bool in_view =
            d.norm() <= 12 && std::abs(wrap_angle(std::atan2(d.y(), d.x()) - pose.yaw)) <= angle / 2;
        if (in_view) unseen += std::log(1 - options.detection * l.quality);
        if ((l.at - at).norm() < nearest)
          nearest = (l.at - at).norm(), matched = std::log(1 - options.detection * l.quality);
      }
      // Where the sighting surely has no landmark nothing else changes; where it has, that one is not unseen.
      if (nearest > 3)
        EXPECT_NEAR(full, plain + unseen, 1e-9);
      else
        EXPECT_LE(full, plain + unseen - matched + 1e-9) << nearest;
    }
  }
}

TEST(SightingMemory, CarriesWhatWasSeenAlong) {
  MadeDrive drive(31);
  drive.noise = {1e-9, 1e-9, 1e-9, 1e-9, 1e-12, 1e-12};
  SightingMemory memory;
  for (int i = 0; i < 30; ++i) {
    memory.predict(drive.drive());
    memory.add(drive.look());
  }
  const SightingSet all = memory.recall(200).set;
  EXPECT_GT(all.sightings.size(), drive.look().sightings.size());
  for (const SeenLandmark& s : all.sightings) {
    ASSERT_TRUE(s.is_valid());
    const Pose2 at =
        drive.truth() * Pose2{*s.range * std::cos(*s.bearing), *s.range * std::sin(*s.bearing), 0};
    EXPECT_LT((at.at() - drive.map()[*s.identity - 1].at).norm(), 0.6);
  }
}

// Odometry whose lasting errors are estimated has motions with covariances that are not positive.
TEST(SightingMemory, IsNotBentByCovariancesThatAreNotPositive) {
  MadeDrive drive(33);
  SightingMemory memory;
  for (int i = 0; i < 60; ++i) {
    BodyMotion motion = drive.drive();
    motion.covariance(0, 0) -= 0.0015;  // along: -0.0005 m^2
    memory.predict(motion);
    memory.add(drive.look());
    const RememberedSightings all = memory.recall(200);
    ASSERT_TRUE(all.robot_covariance.allFinite()) << i;
    for (int k = 0; k < 3; ++k) EXPECT_GE(all.robot_covariance(k, k), -1e-12) << i;
    for (const SeenLandmark& s : all.set.sightings) {
      ASSERT_TRUE(s.is_valid());
      const Pose2 at =
          drive.truth() * Pose2{*s.range * std::cos(*s.bearing), *s.range * std::sin(*s.bearing), 0};
      EXPECT_LT((at.at() - drive.map()[*s.identity - 1].at).norm(), 1) << i;
    }
  }
}

TEST(ParticleFilter, ConstellationsFindThePlaceInALargeMap) {
  // 4000 particles drawn at 20,000 landmarks would miss it.
  auto landmarks = scatter_landmarks(20000, 1000, 41);
  Random random(2, "drive in a large map");
  for (MapLandmark& l : landmarks) l.features.value[0] = random.log_uniform(0.2, 1);
  const auto index = std::make_shared<ConstellationIndex>(landmarks, FeatureScales{});
  ParticleOptions options;
  options.threads = 1;
  IdentificationOptions id;
  id.use_identities = false;
  ParticleFilter filter({}, LandmarkMatcher(LandmarkWindow{LandmarkGrid(landmarks)}, {}, id), options,
                        [&](const SightingSet& seen) {
                          PoseSearchResult found;
                          const auto answer = index->find(seen);
                          if (answer.fix) found.accepted = answer.fix->pose();
                          for (const auto& fix : answer.candidates) found.candidates.push_back(fix.pose());
                          return found;
                        });
  Pose2 truth{211, -130, 1};
  for (int i = 0; i < 12; ++i) {
    const BodyMotion motion = twist_motion(1, 0, 0.1, 0.5, {});
    truth = truth * motion.step;
    filter.predict(motion);
    SightingSet seen;
    for (const MapLandmark& l : landmarks) {
      const Eigen::Vector2d d = l.at - truth.at();
      if (d.norm() > 10) continue;
      SeenLandmark s;
      s.type = TypeId{0};
      s.range = d.norm() + 0.05 * random.normal();
      s.range_sd = 0.05;
      s.bearing = wrap_angle(std::atan2(d.y(), d.x()) - truth.yaw + 0.01 * random.normal());
      s.bearing_sd = 0.01;
      s.features.value[0] = l.features.value[0] * (1 + 0.05 * random.normal());
      seen.sightings.push_back(s);
    }
    filter.update(seen);
    ASSERT_TRUE(filter.estimate().pose.finite());
  }
  EXPECT_LT((filter.estimate().pose.at() - truth.at()).norm(), 0.3);
  EXPECT_EQ(filter.status(), LocalizationStatus::tracking);
}

struct RocksAbout {
  std::vector<MapLandmark> map = scatter_landmarks(5000, 500, 43);
  Random random{3, "looks from nowhere"};
  Pose2 truth{40, -30, 1};
  std::shared_ptr<ConstellationIndex> index;
  IdentificationOptions id;

  explicit RocksAbout(bool identities) {
    ConstellationOptions options;
    id.use_identities = options.identification.use_identities = identities;
    index = std::make_shared<ConstellationIndex>(map, FeatureScales{}, options);
  }
  PoseFinder finder() const {
    return [index = index](const SightingSet& seen) {
      PoseSearchResult found;
      const auto answer = index->find(seen);
      if (answer.fix) found.accepted = answer.fix->pose();
      for (const auto& fix : answer.candidates) found.candidates.push_back(fix.pose());
      return found;
    };
  }
  SightingSet look(double reach, std::size_t most, bool named) {
    SightingSet seen;
    for (const MapLandmark& l : map) {
      const Eigen::Vector2d d = l.at - truth.at();
      if (d.norm() > reach || seen.sightings.size() == most) continue;
      SeenLandmark s;
      s.type = TypeId{0};
      s.range = d.norm() + 0.05 * random.normal();
      s.range_sd = 0.05;
      s.bearing = wrap_angle(std::atan2(d.y(), d.x()) - truth.yaw + 0.01 * random.normal());
      s.bearing_sd = 0.01;
      if (named) s.identity = l.key;
      seen.sightings.push_back(s);
    }
    return seen;
  }
};

TEST(ParticleFilter, ARobotAtRestGathersNoEvidence) {
  // Three rocks without identities fit at thousands of places; seen a hundred times they still do.
  RocksAbout site(false);
  ParticleFilter filter({}, LandmarkMatcher(LandmarkWindow{LandmarkGrid(site.map)}, {}, site.id),
                        {.threads = 1, .weight = {}}, site.finder());
  for (int i = 0; i < 100; ++i) {
    filter.predict(step_motion({}, 0.5, {}));
    filter.update(site.look(15, 3, false));
    ASSERT_NE(filter.status(), LocalizationStatus::tracking) << i;
    ASSERT_GT(filter.estimate().covariance(0, 0), 1000) << i;
  }
}

TEST(ParticleFilter, OneSetOfIdentifiedLandmarksIsEnough) {
  RocksAbout site(true);
  ParticleFilter filter({}, LandmarkMatcher(LandmarkWindow{LandmarkGrid(site.map)}, {}, site.id),
                        {.threads = 1, .weight = {}}, site.finder());
  filter.update(site.look(15, 4, true));
  EXPECT_EQ(filter.status(), LocalizationStatus::tracking);
  EXPECT_LT((filter.estimate().pose.at() - site.truth.at()).norm(), 0.3);
  EXPECT_LT(filter.estimate().covariance(0, 0), 0.1);
}

// Where the constellation of what is remembered is not in the map, that of the present set may be.
TEST(ParticleFilter, IsFoundByThePresentSetBesideABentMemory) {
  RocksAbout site(true);
  int calls = 0;
  const auto finder = [&calls, find = site.finder()](const SightingSet& seen) {
    return ++calls == 1 ? PoseSearchResult{} : find(seen);
  };
  ParticleFilter filter({}, LandmarkMatcher(LandmarkWindow{LandmarkGrid(site.map)}, {}, site.id),
                        {.threads = 1, .weight = {}}, finder);
  filter.update(site.look(15, 4, true));
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(filter.status(), LocalizationStatus::tracking);
}

TEST(SightingMemory, SeenAgainIsOneObject) {
  RocksAbout site(false);
  SightingMemory memory;
  const std::size_t count = site.look(10, 100, false).sightings.size();
  for (int i = 0; i < 50; ++i) {
    memory.predict(step_motion({}, 0.5, {}));
    memory.add(site.look(10, 100, false));
  }
  EXPECT_LE(memory.recall(200).set.sightings.size(), count);
}

}  // namespace
}  // namespace waymark::test
