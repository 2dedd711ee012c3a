// SPDX-License-Identifier: Apache-2.0
// Map errors that a robot measures repeatedly.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>

#include "core/random.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/motion_model.hpp"

namespace waymark::test {
using namespace localization;
namespace {

// A machine drives slowly through landmarks whose places on the map err by half a metre per axis. Returns the
// mean of the squared errors over the variances the filter claims.
double consistency(double error_correlation_distance) {
  double sum = 0;
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
    MultiHypothesisFilter filter(start,
                                 LandmarkMatcher(LandmarkWindow{LandmarkGrid(map)}, {}, {.gate = 0.999}),
                                 {.error_correlation_distance = error_correlation_distance, .search = {}});
    Pose2 truth;
    for (int step = 0; step < 80; ++step) {
      const BodyMotion odometry = twist_motion(0.5, 0, 0, 1, {});
      const Eigen::Vector3d off = odometry.covariance.diagonal().cwiseSqrt().cwiseProduct(
          Eigen::Vector3d(random.normal(), random.normal(), random.normal()));
      truth = truth * pose_of(odometry.step.vector() + off);
      filter.predict(odometry);
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
      filter.update(seen);
      if (step < 20) continue;
      const PoseEstimate e = filter.estimate();
      const Eigen::Vector2d error = e.pose.at() - truth.at();
      sum += error.dot(e.covariance.topLeftCorner<2, 2>().inverse() * error) / 2;
      ++rows;
    }
  }
  return sum / rows;
}

TEST(MultiHypothesisFilter, KnowsThatTheMapErrsTheSameWayAgain) {
  const double independent = consistency(0), alike = consistency(15);
  std::printf("mean squared error over claimed variance: %.1f taken as independent, %.1f as alike\n",
              independent, alike);
  EXPECT_GT(independent, 2) << "the test must show the effect";
  EXPECT_LT(alike, 0.5 * independent);
  EXPECT_LT(alike, 2);
  EXPECT_GT(alike, 0.2);
}

}  // namespace
}  // namespace waymark::test
