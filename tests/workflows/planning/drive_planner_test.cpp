// SPDX-License-Identifier: Apache-2.0
// Routes that a vehicle plans while it drives.
#include "workflows/planning/drive_planner.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace waymark::test {
namespace {

using namespace workflows;

/// Landmarks along y = 12, from x = 0 to 60.
localization::LandmarkGrid row_of_landmarks() {
  std::vector<localization::MapLandmark> row;
  for (int x = 0; x <= 60; x += 4) {
    localization::MapLandmark l;
    l.key = static_cast<localization::LandmarkKey>(x + 1);
    l.at = {x, 12};
    l.covariance = Eigen::Matrix2d::Identity() * 0.01;
    row.push_back(l);
  }
  return localization::LandmarkGrid(std::move(row));
}

DrivePlanner planner_with(localization::LineOfSight visible, double limit = 0) {
  SensorCoverage laser;
  laser.range = 15, laser.range_sd = 0.1, laser.bearing_sd = 0.5;
  localization::OdometryNoise noise;
  noise.along_per_metre = noise.across_per_metre = 0.01;
  noise.yaw_per_metre = 1e-5, noise.yaw_per_radian = 1e-4;
  return DrivePlanner(
      row_of_landmarks(),
      {.coverage = laser, .limit_sigma = limit, .noise = noise, .visible = std::move(visible)}, nullptr);
}

localization::PoseEstimate start() {
  localization::PoseEstimate estimate;
  estimate.covariance = Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal();
  return estimate;
}

/// From below y = 6 a ridge hides the landmarks.
bool above_the_ridge(const localization::Pose2& sensor, const Eigen::Vector2d&) {
  return sensor.y > 6;
}

TEST(DrivePlanner, TerrainThatHidesLandmarksMakesAPathLessSure) {
  std::vector<Eigen::Vector2d> path;
  for (int x = 2; x <= 60; x += 2) path.emplace_back(x, 0);
  const double free = planner_with({}).expected_sd(start(), path, {});
  const double hidden = planner_with(above_the_ridge).expected_sd(start(), path, {});
  const double none =
      planner_with([](const auto&, const auto&) { return false; }).expected_sd(start(), path, {});
  EXPECT_GT(hidden, 3 * free);
  EXPECT_DOUBLE_EQ(hidden, none);
}

TEST(DrivePlanner, ALimitLeadsToWhereTerrainShowsLandmarks) {
  const DrivePlanRequest request{.from = start(), .to = {60, 0}, .obstacles = {}};
  const double limit = 0.4;
  const auto straight = planner_with({}, limit).plan(request);
  const auto around = planner_with(above_the_ridge, limit).plan(request);
  ASSERT_TRUE(straight && around);
  EXPECT_TRUE(straight->keeps_limit && around->keeps_limit);
  EXPECT_GT(around->length, straight->length + 3);
  EXPECT_LE(around->worst_sd, limit);
}

}  // namespace
}  // namespace waymark::test
