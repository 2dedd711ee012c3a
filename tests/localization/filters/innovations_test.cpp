// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/random.hpp"
#include "landmarks/landmark_type.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/filters/measurement.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/replay_log.hpp"
#include "localization/robot_log.hpp"
#include "localization/track_score.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

const Eigen::Matrix3d kPrior = Eigen::Vector3d(0.04, 0.02, 1e-4).asDiagonal();

std::vector<MapLandmark> beacons() {
  std::vector<MapLandmark> all;
  for (int i = 0; i < 3; ++i) {
    MapLandmark l;
    l.at = {8.0 + 2 * i, 5.0 * (i - 1)};
    l.covariance << 0.01, 0.003, 0.003, 0.02;
    l.key = static_cast<LandmarkKey>(i + 1);
    all.push_back(l);
  }
  return all;
}

// One set of sightings of all beacons from a pose drawn from the prior, of beacons drawn from their
// covariance.
RobotLog one_look(std::uint64_t seed) {
  Random random(seed, "innovations");
  const auto draw = [&](const auto& covariance) {
    auto e = covariance.col(0).eval();
    for (auto& v : e) v = random.normal();
    return (covariance.llt().matrixL() * e).eval();
  };
  const Pose2 at = pose_of(draw(kPrior));
  SightingSet set;
  for (const MapLandmark& l : beacons()) {
    const ExpectedSighting e = expect(at, {}, l.at + draw(l.covariance));
    SeenLandmark s;
    s.identity = l.key;
    s.range_sd = 0.1, s.bearing_sd = 0.01;
    s.range = e.value[0] + random.normal(0, 0.1);
    s.bearing = e.value[1] + random.normal(0, 0.01);
    set.sightings.push_back(s);
  }
  RobotLog log;
  log.events.push_back({0, set});
  return log;
}

TrackRow row_of(Localizer& filter, const RobotLog& log, double noise = 1) {
  ReplayOptions options;
  options.sensor_noise = noise;
  return replay(log, filter, options).rows.at(0);
}

ExtendedKalman ekf() {
  IdentificationOptions options;
  options.quality_floor = 1;
  return {{{}, kPrior}, LandmarkMatcher(LandmarkWindow{LandmarkGrid(beacons())}, {}, options)};
}

// v' S^-1 v with the matrices written out.
double by_hand(const RobotLog& log) {
  const auto& seen = std::get<SightingSet>(log.events[0].what).sightings;
  const auto map = beacons();
  Eigen::Matrix<double, 6, 3> h;
  Eigen::Matrix<double, 6, 6> r = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> v;
  for (int i = 0; i < 3; ++i) {
    const auto& s = seen[static_cast<std::size_t>(i)];
    const auto& l = map[static_cast<std::size_t>(i)];
    const ExpectedSighting e = expect({}, {}, l.at);
    h.middleRows<2>(2 * i) = e.by_pose;
    r.block<2, 2>(2 * i, 2 * i) = sensor_noise(s) + e.by_landmark * l.covariance * e.by_landmark.transpose();
    v.segment<2>(2 * i) = innovation(s, e.value);
  }
  return v.dot((h * kPrior * h.transpose() + r).inverse() * v);
}

TEST(Innovations, AreThoseOfTheWholeSetWrittenOut) {
  int whole = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const RobotLog log = one_look(seed);
    auto filter = ekf();
    const TrackRow row = row_of(filter, log);
    if (row.matched < 3) continue;  // one in a hundred sightings is outside the gate
    ++whole;
    EXPECT_EQ(row.nis_rows, 6);
    EXPECT_NEAR(row.nis, by_hand(log), 1e-9 * (1 + row.nis));
  }
  EXPECT_GT(whole, 40);
}

TEST(Innovations, AreChiSquareWhereTheFilterIsRight) {
  Track right, sure;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    auto filter = ekf(), doubled = ekf();
    right.rows.push_back(row_of(filter, one_look(seed)));
    sure.rows.push_back(row_of(doubled, one_look(seed), 0.3));
    right.rows.back().t = sure.rows.back().t = double(seed);
  }
  const TrackScore good = score(right, {}, TrackAlignment::none, true);
  ASSERT_TRUE(good.innovations);
  EXPECT_GT(good.innovations->anees, 0.92);
  EXPECT_LT(good.innovations->anees, 1.08);
  EXPECT_GT(score(sure, {}, TrackAlignment::none, true).innovations->anees, good.innovations->high);
}

TEST(Innovations, AreReportedByAMultiHypothesisFilter) {
  const RobotLog log = one_look(3);
  IdentificationOptions options;
  options.quality_floor = 1;
  MultiHypothesisFilter filter({{}, kPrior},
                               LandmarkMatcher(LandmarkWindow{LandmarkGrid(beacons())}, {}, options));
  EXPECT_NEAR(row_of(filter, log).nis, by_hand(log), 1e-9);
}

TEST(Innovations, NoneWhereNothingIsMatched) {
  DeadReckoning robot({});
  const TrackRow row = row_of(robot, one_look(1));
  EXPECT_EQ(row.nis_rows, 0);
  EXPECT_EQ(row.nis, 0);
  Track track;
  track.rows = {row};
  EXPECT_FALSE(score(track, {}, TrackAlignment::none, true).innovations);
}

}  // namespace
}  // namespace waymark::test
