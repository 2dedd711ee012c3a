// SPDX-License-Identifier: Apache-2.0
// Map errors that a robot measures repeatedly.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>

#include "core/random.hpp"
#include "localization/filters/map_errors.hpp"
#include "localization/filters/measurement.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/motion_model.hpp"

namespace waymark::test {
using namespace localization;
namespace {

// A machine drives slowly through landmarks whose places on the map err by half a metre per axis. Returns the
// mean of the squared errors over the variances that the filter claims, and over those that it corrects by.
struct Consistency {
  double claimed = 0, assumed = 0;
};
using MakeFilter =
    std::function<std::unique_ptr<Localizer>(const PoseEstimate& start, LandmarkMatcher matcher)>;
Consistency consistency(const MakeFilter& make) {
  Consistency sum;
  int rows = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed, "map errors");
    std::vector<MapLandmark> map(120);
    std::vector<Eigen::Vector2d> real;
    for (std::size_t i = 0; i < map.size(); ++i) {
      real.emplace_back(random.uniform(-12, 60), random.uniform(-15, 15));
      map[i].key = i + 1;
      map[i].at = real[i] + 0.5 * Eigen::Vector2d(random.normal(), random.normal());
      map[i].covariance = Eigen::Matrix2d::Identity() * 0.25;
    }
    PoseEstimate start;
    start.covariance = Eigen::Vector3d(0.25, 0.25, 0.01).asDiagonal();
    const auto filter = make(start, LandmarkMatcher(LandmarkWindow{LandmarkGrid(map)}, {}, {.gate = 0.999}));
    Pose2 truth;
    for (int step = 0; step < 80; ++step) {
      const BodyMotion odometry = twist_motion(0.5, 0, 0, 1, {});
      const Eigen::Vector3d off = odometry.covariance.diagonal().cwiseSqrt().cwiseProduct(
          Eigen::Vector3d(random.normal(), random.normal(), random.normal()));
      truth = truth * pose_of(odometry.step.vector() + off);
      filter->predict(odometry);
      SightingSet seen;
      for (std::size_t i = 0; i < real.size(); ++i) {
        const Eigen::Vector2d d = real[i] - truth.at();
        if (d.norm() > 10) continue;
        SeenLandmark s;
        s.range = d.norm() + random.normal(0, 0.05);
        s.range_sd = 0.05;
        s.bearing = wrap_angle(std::atan2(d.y(), d.x()) - truth.yaw + random.normal(0, 0.005));
        s.bearing_sd = 0.005;
        s.identity = i + 1;
        seen.sightings.push_back(s);
      }
      filter->update(seen);
      if (step < 20) continue;
      const auto squares = [&](const PoseEstimate& e) {
        const Eigen::Vector2d error = e.pose.at() - truth.at();
        return error.dot(e.covariance.topLeftCorner<2, 2>().inverse() * error) / 2;
      };
      sum.claimed += squares(filter->estimate()), sum.assumed += squares(filter->assumed_estimate());
      ++rows;
    }
  }
  return {sum.claimed / rows, sum.assumed / rows};
}

double consistency(double error_correlation_distance) {
  const auto make = [&](const PoseEstimate& start, LandmarkMatcher matcher) {
    return std::make_unique<MultiHypothesisFilter>(
        start, std::move(matcher),
        MultiHypothesisOptions{.error_correlation_distance = error_correlation_distance, .search = {}});
  };
  return consistency(make).claimed;
}

TEST(ParticleFilter, KnowsThatTheMapErrsTheSameWayAgain) {
  const Consistency found = consistency([](const PoseEstimate& start, LandmarkMatcher matcher) {
    return std::make_unique<ParticleFilter>(start, std::move(matcher));
  });
  std::printf("mean squared error over claimed variance: %.2f, over that of the particles: %.2f\n",
              found.claimed, found.assumed);
  EXPECT_GT(found.claimed, 0.7);
  EXPECT_LT(found.claimed, 1.4);
}

TEST(MultiHypothesisFilter, KnowsThatTheMapErrsTheSameWayAgain) {
  const double independent = consistency(0), alike = consistency(200);
  std::printf("mean squared error over claimed variance: %.1f taken as independent, %.1f as alike\n",
              independent, alike);
  EXPECT_GT(independent, 2) << "the test must show the effect";
  EXPECT_LT(alike, 0.5 * independent);
  EXPECT_LT(alike, 2);
  EXPECT_GT(alike, 0.2);
}

// The slow twin: one state of pose and all landmarks, whose rows of the gain are set to zero (Schmidt 1966).
struct PoseAndLandmarks {
  Pose2 pose;
  Eigen::MatrixXd covariance;

  void predict(const BodyMotion& motion) {
    const MotionJacobians j = motion_jacobians(pose, motion.step);
    Eigen::MatrixXd f = Eigen::MatrixXd::Identity(covariance.rows(), covariance.rows());
    f.topLeftCorner<3, 3>() = j.by_pose;
    covariance = (f * covariance * f.transpose()).eval();
    covariance.topLeftCorner<3, 3>() += j.by_step * motion.covariance * j.by_step.transpose();
    pose = pose * motion.step;
  }
  void correct(const SeenLandmark& seen, const Eigen::Vector2d& at, Eigen::Index which) {
    const ExpectedSighting e = expect(pose, {}, at);
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(2, covariance.rows());
    h.leftCols<3>() = e.by_pose, h.middleCols<2>(3 + 2 * which) = e.by_landmark;
    const Eigen::Matrix2d r = sensor_noise(seen), s = h * covariance * h.transpose() + r;
    Eigen::MatrixXd gain = covariance * h.transpose() * s.inverse();
    gain.bottomRows(covariance.rows() - 3).setZero();
    correct_by(gain.topRows<3>(), seen, at, which);
  }
  // By the gain of another.
  void correct_by(const Eigen::Matrix<double, 3, 2>& by, const SeenLandmark& seen, const Eigen::Vector2d& at,
                  Eigen::Index which) {
    const ExpectedSighting e = expect(pose, {}, at);
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(2, covariance.rows());
    h.leftCols<3>() = e.by_pose, h.middleCols<2>(3 + 2 * which) = e.by_landmark;
    const Eigen::Matrix2d r = sensor_noise(seen);
    Eigen::MatrixXd gain = Eigen::MatrixXd::Zero(covariance.rows(), 2);
    gain.topRows<3>() = by;
    pose = pose_of(pose.vector() + gain.topRows<3>() * innovation(seen, e.value));
    const Eigen::MatrixXd a = Eigen::MatrixXd::Identity(covariance.rows(), covariance.rows()) - gain * h;
    covariance = (a * covariance * a.transpose() + gain * r * gain.transpose()).eval();
  }
};

TEST(MapErrors, AreThoseOfAStateWithAllLandmarks) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed, "consider");
    std::vector<MapLandmark> map(4);
    PoseAndLandmarks whole{{}, Eigen::MatrixXd::Zero(11, 11)};
    whole.covariance.topLeftCorner<3, 3>() = Eigen::Vector3d(0.1, 0.2, 0.01).asDiagonal();
    for (std::size_t i = 0; i < map.size(); ++i) {
      map[i].key = 100 - i;
      map[i].at = {random.uniform(5, 20), random.uniform(-10, 10)};
      const double a = random.uniform(0.01, 0.3), b = random.uniform(0.01, 0.3);
      map[i].covariance << a, 0.3 * std::sqrt(a * b), 0.3 * std::sqrt(a * b), b;
      const auto row = static_cast<Eigen::Index>(3 + 2 * i);
      whole.covariance.block<2, 2>(row, row) = map[i].covariance;
    }
    PoseEstimate at{{}, whole.covariance.topLeftCorner<3, 3>()};
    MapErrors errors;
    for (int k = 0; k < 40; ++k) {
      const BodyMotion motion = twist_motion(0.2, 0, random.uniform(-0.1, 0.1), 1, {});
      whole.predict(motion);
      errors.predict(at.pose, motion.step);
      at = predict_pose(at, motion);
      const std::size_t which = random.uniform_index(map.size());
      SeenLandmark s;
      const ExpectedSighting e = expect(at.pose, {}, map[which].at);
      s.range = e.value[0] + random.normal(0, 0.1), s.range_sd = 0.1;
      s.bearing = wrap_angle(e.value[1] + random.normal(0, 0.02)), s.bearing_sd = 0.02;
      whole.correct(s, map[which].at, static_cast<Eigen::Index>(which));
      at = errors.correct(at, s, {}, map[which], 1);
      ASSERT_LT((at.covariance - whole.covariance.topLeftCorner<3, 3>()).norm(), 1e-9) << seed << ' ' << k;
      ASSERT_LT((at.pose.vector() - whole.pose.vector()).norm(), 1e-9) << seed << ' ' << k;
    }
  }
}

// A localizer that takes the errors for new, but larger, has other errors than it assumes.
TEST(MapErrors, OfAnotherLocalizerAreThoseOfItsGain) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed, "follow");
    std::vector<MapLandmark> map(4);
    PoseAndLandmarks whole{{}, Eigen::MatrixXd::Zero(11, 11)};
    whole.covariance.topLeftCorner<3, 3>() = Eigen::Vector3d(0.1, 0.2, 0.01).asDiagonal();
    for (std::size_t i = 0; i < map.size(); ++i) {
      map[i].key = i + 1;
      map[i].at = {random.uniform(5, 20), random.uniform(-10, 10)};
      map[i].covariance = random.uniform(0.01, 0.3) * Eigen::Matrix2d::Identity();
      const auto row = static_cast<Eigen::Index>(3 + 2 * i);
      whole.covariance.block<2, 2>(row, row) = map[i].covariance;
    }
    const Eigen::Matrix3d start = whole.covariance.topLeftCorner<3, 3>();
    MapErrors::Covariances both{start, start};
    MapErrors errors;
    for (int k = 0; k < 40; ++k) {
      const BodyMotion motion = twist_motion(0.2, 0, random.uniform(-0.1, 0.1), 1, {});
      const Pose2 from = whole.pose;
      errors.predict(from, motion.step);
      both = {predict_pose({from, both.real}, motion).covariance,
              predict_pose({from, both.assumed}, motion).covariance};
      whole.predict(motion);
      const std::size_t which = random.uniform_index(map.size());
      const double factor = 1 + k % 5;
      SeenLandmark s;
      const ExpectedSighting e = expect(whole.pose, {}, map[which].at);
      s.range = e.value[0] + random.normal(0, 0.1), s.range_sd = 0.1;
      s.bearing = wrap_angle(e.value[1] + random.normal(0, 0.02)), s.bearing_sd = 0.02;
      const Eigen::Matrix<double, 3, 2> with = both.assumed * e.by_pose.transpose();
      const Eigen::Matrix2d seen =
          e.by_pose * with + factor * e.by_landmark * map[which].covariance * e.by_landmark.transpose() +
          sensor_noise(s);
      const Eigen::Matrix<double, 3, 2> gain = with * seen.inverse();
      const Eigen::Matrix3d assumed = both.assumed - gain * with.transpose();
      both = errors.follow(whole.pose, both, s, {}, map[which], factor);
      whole.correct_by(gain, s, map[which].at, static_cast<Eigen::Index>(which));
      ASSERT_LT((both.real - whole.covariance.topLeftCorner<3, 3>()).norm(), 1e-9) << seed << ' ' << k;
      ASSERT_LT((both.assumed - assumed).norm(), 1e-9) << seed << ' ' << k;
    }
  }
}

TEST(MapErrors, ALandmarkSeenForEverIsAsCertainAsItWasMapped) {
  MapLandmark landmark{
      .key = 1, .at = {10, 0}, .covariance = 0.04 * Eigen::Matrix2d::Identity(), .features = {}};
  SeenLandmark s;
  s.range = 10, s.range_sd = 0.05, s.bearing = 0, s.bearing_sd = 0.01;
  for (const bool unscented : {false, true}) {
    PoseEstimate at{{}, Eigen::Vector3d(1, 1, 1e-6).asDiagonal()};
    MapErrors errors;
    for (int i = 0; i < 1000; ++i) at = errors.correct(at, s, {}, landmark, 1, unscented);
    EXPECT_NEAR(std::sqrt(at.covariance(0, 0)), 0.2, 0.01) << unscented;
    MapErrors independent(0);
    PoseEstimate sure{{}, Eigen::Vector3d(1, 1, 1e-6).asDiagonal()};
    for (int i = 0; i < 1000; ++i) sure = independent.correct(sure, s, {}, landmark, 1, unscented);
    EXPECT_LT(std::sqrt(sure.covariance(0, 0)), 0.01) << unscented;
  }
}

// A motion may undo much of a pose's error (PersistentErrors), and what is kept of a landmark is then more
// than pose and landmark allow.
TEST(MapErrors, NoVarianceBecomesNegative) {
  MapLandmark landmark;
  landmark.key = 1, landmark.at = {8, 3}, landmark.covariance = Eigen::Matrix2d::Identity() * 0.09;
  SeenLandmark seen;
  seen.range = std::hypot(8, 3), seen.range_sd = 0.02;
  seen.bearing = std::atan2(3, 8), seen.bearing_sd = 0.002;
  for (double undone = 0.5; undone <= 1; undone += 0.01) {
    MapErrors errors;
    PoseEstimate pose;
    pose.covariance = Eigen::Vector3d(0.5, 0.5, 0.02).asDiagonal();
    for (int i = 0; i < 5; ++i) {
      pose = errors.correct(pose, seen, {}, landmark, 1);
      Eigen::LLT<Eigen::Matrix3d> root(pose.covariance);
      EXPECT_EQ(root.info(), Eigen::Success) << undone << ", sighting " << i << "\n" << pose.covariance;
      pose.covariance *= undone;
    }
  }
}

// What is kept of many landmarks may together be more than the pose allows, each by itself not. Knowing all
// map errors exactly would leave a fiftieth of the pose's covariance; the sighting adds its own information.
TEST(MapErrors, NoPoseIsMoreCertainThanByKnownErrors) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed, "many landmarks");
    std::vector<MapLandmark> map(12);
    for (std::size_t i = 0; i < map.size(); ++i) {
      map[i].key = i + 1;
      map[i].at = {random.uniform(-15, 15), random.uniform(-15, 15)};
      map[i].covariance = Eigen::Matrix2d::Identity() * 0.01;
    }
    PoseEstimate at{{}, Eigen::Vector3d(0.1, 0.1, 0.01).asDiagonal()};
    MapErrors errors;
    for (int set = 0; set < 50; ++set) {
      const BodyMotion motion = twist_motion(0.1, 0, random.uniform(-0.3, 0.3), 1, {});
      errors.predict(at.pose, motion.step);
      at = predict_pose(at, motion);
      at.covariance *= random.uniform(0.3, 1);
      Eigen::Matrix3d most_information = 50 * at.covariance.inverse();
      for (const MapLandmark& landmark : map) {
        const ExpectedSighting e = expect(at.pose, {}, landmark.at);
        SeenLandmark s;
        s.range = e.value[0], s.range_sd = 0.1, s.bearing = e.value[1], s.bearing_sd = 0.01;
        most_information += e.by_pose.transpose() * sensor_noise(s).inverse() * e.by_pose;
        at = errors.correct(at, s, {}, landmark, 1);
      }
      const Eigen::Matrix3d root = Eigen::LLT<Eigen::Matrix3d>(most_information).matrixL();
      const Eigen::Matrix3d ratio = root.transpose() * at.covariance * root;
      const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(ratio).eigenvalues()[0];
      ASSERT_GT(least, 0.9) << "seed " << seed << ", set " << set;
    }
  }
}

}  // namespace
}  // namespace waymark::test
