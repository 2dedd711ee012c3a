// SPDX-License-Identifier: Apache-2.0
// Landmarks that a sighting can be taken for, against drawn sightings.
#include "planning/rivals.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/random.hpp"
#include "planning/world_beliefs.hpp"

namespace waymark::test {
namespace {

using namespace planning;

localization::MapLandmark rival_at(double x, double y, double sd = 0.1, TypeId type = 0) {
  localization::MapLandmark l;
  l.key = static_cast<localization::LandmarkKey>(1000 * x + y + 1e6);
  l.at = {x, y};
  l.covariance = Eigen::Matrix2d::Identity() * sd * sd;
  l.type = type;
  return l;
}

std::uint32_t index_at(const localization::LandmarkGrid& map, double x, double y) {
  for (std::uint32_t i = 0; i < map.size(); ++i)
    if (map[i].at == Eigen::Vector2d(x, y)) return i;
  throw std::logic_error("no landmark there");
}

SensorCoverage rival_laser() {
  SensorCoverage sensor;
  sensor.range = 30, sensor.range_sd = 0.1, sensor.bearing_sd = 1;
  return sensor;
}

/// Draws pose errors, errors of both landmarks and of the sensor, and counts how often a sighting of
/// `landmark` lies nearer to another one, by the covariance of all these errors.
double drawn_rivals(const Symmetric3& belief, const localization::Pose2& pose,
                    const localization::LandmarkGrid& map, std::uint32_t landmark,
                    const SensorCoverage& sensor, int draws) {
  Random random(7, "rivals");
  const Eigen::Matrix3d root = belief.matrix().llt().matrixL();
  const Eigen::Vector2d to = map[landmark].at - pose.at();
  const double bearing_sd = sensor.bearing_sd * M_PI / 180;
  const auto normal2 = [&] { return Eigen::Vector2d(random.normal(), random.normal()); };
  const auto error = [&](std::uint32_t k) -> Eigen::Vector2d {
    const Eigen::Vector3d e = root * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    const Eigen::Vector2d w(-to.y(), to.x()), u = to.normalized();
    return e.head<2>() + w * (e.z() + bearing_sd * random.normal()) + u * sensor.range_sd * random.normal() +
           std::sqrt(map[landmark].covariance(0, 0)) * normal2() +
           std::sqrt(map[k].covariance(0, 0)) * normal2();
  };
  double sum = 0;
  for (std::uint32_t k = 0; k < map.size(); ++k) {
    if (k == landmark || map[k].type != map[landmark].type) continue;
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    for (int i = 0; i < draws; ++i) {
      const Eigen::Vector2d e = error(k);
      covariance += e * e.transpose() / draws;
    }
    const Eigen::Matrix2d weight = covariance.inverse();
    const Eigen::Vector2d apart = map[k].at - map[landmark].at;
    int nearer = 0;
    for (int i = 0; i < draws; ++i) {
      const Eigen::Vector2d e = error(k), of_other = e - apart;
      nearer += of_other.dot(weight * of_other) < e.dot(weight * e);
    }
    sum += map[k].quality * nearer / draws;
  }
  return sum;
}

TEST(Rivals, AreAsManyAsDrawnSightingsHave) {
  auto doubtful = rival_at(12, 3.5);
  doubtful.quality = 0.4;
  const localization::LandmarkGrid map(
      {rival_at(12, 2), doubtful, rival_at(13.2, 2.3, 0.3), rival_at(11, 2, 0.1, 1), rival_at(40, 40)});
  const Rivals rivals(map);
  const localization::Pose2 pose{1, -2, 0.3};
  for (const Symmetric3& belief :
       {Symmetric3{0.3, 0.1, 0.2, 0.01, -0.02, 0.01}, Symmetric3{2, -0.5, 1, 0.05, 0.05, 0.02},
        Symmetric3{0.01, 0, 0.01, 0, 0, 1e-4}}) {
    const std::uint32_t landmark = index_at(map, 12, 2);
    const double drawn = drawn_rivals(belief, pose, map, landmark, rival_laser(), 40'000);
    EXPECT_NEAR(rivals.expected(belief, pose, landmark, rival_laser()), drawn, 0.01 + 0.02 * drawn);
  }
}

TEST(Rivals, AreHalfOfATwinAndNoneOfALoneOrADifferentOne) {
  const localization::LandmarkGrid map(
      {rival_at(10, 0), rival_at(10, 0.0001), rival_at(60, 0), rival_at(60.5, 0, 0.1, 1)});
  const Rivals rivals(map);
  const Symmetric3 belief{0.04, 0, 0.04, 0, 0, 1e-4};
  EXPECT_NEAR(rivals.expected(belief, {}, index_at(map, 10, 0), rival_laser()), 0.5, 1e-3);
  EXPECT_EQ(rivals.expected(belief, {50, 0, 0}, index_at(map, 60, 0), rival_laser()), 0);
}

TEST(Rivals, GrowWithTheCovariance) {
  Random random(11, "rivals grow");
  std::vector<localization::MapLandmark> rocks;
  for (int i = 0; i < 60; ++i) rocks.push_back(rival_at(random.uniform(0, 40), random.uniform(0, 40)));
  const localization::LandmarkGrid map(std::move(rocks));
  const Rivals rivals(map);
  for (const double range_sd : {0.1, 0.0}) {
    SensorCoverage sensor = rival_laser();
    sensor.range_sd = range_sd;
    for (int i = 0; i < 200; ++i) {
      Eigen::Matrix3d root, more;
      for (int k = 0; k < 9; ++k) root(k) = random.normal() * 0.3, more(k) = random.normal() * 0.3;
      const Eigen::Matrix3d small = root * root.transpose() * 0.05 + Eigen::Matrix3d::Identity() * 1e-3;
      const auto l = static_cast<std::uint32_t>(random.uniform() * 60);
      const double before = rivals.expected(symmetric(small), {20, 20, 1}, l, sensor);
      const double after =
          rivals.expected(symmetric(small + more * more.transpose() * 0.1), {20, 20, 1}, l, sensor);
      EXPECT_GE(after, before - 1e-6);
    }
  }
}

TEST(Rivals, MakeABeliefLessSureWhereLandmarksResembleOneAnother) {
  const auto sd_after = [](double apart, bool known) {
    std::vector<localization::MapLandmark> rocks;
    for (int i = 0; i < 6; ++i)
      for (int twin = 0; twin < 4; ++twin) rocks.push_back(rival_at(5.0 * i + apart * twin, 5));
    const localization::LandmarkGrid map(std::move(rocks));
    LandmarkSensing sensing{.coverage = rival_laser()};
    sensing.identities_known = known;
    WorldBeliefs beliefs({0.25, 0, 0.25, 0, 0, 1e-3}, {}, map, 8, 1);
    for (int i = 1; i <= 10; ++i) {
      beliefs.drive({2, 1, 0, 0});
      beliefs.see({2.0 * i, 0, 0}, 2, map, sensing);
    }
    return position_sd(beliefs.mean());
  };
  EXPECT_GT(sd_after(0.1, false), 1.2 * sd_after(0.1, true));
  EXPECT_LT(sd_after(1.25, false), 1.05 * sd_after(1.25, true));
}

}  // namespace
}  // namespace waymark::test
