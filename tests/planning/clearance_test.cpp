// SPDX-License-Identifier: Apache-2.0
#include "planning/clearance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
namespace waymark::test {
using namespace planning;
using localization::Pose2;
namespace {

/// Terrain as a sum of waves, and its range by samples of 2 cm widened by their steepest slope.
struct Waves {
  double height(const Eigen::Vector2d& p) const {
    return amplitude * (std::sin(1.7 * p.x()) + std::cos(2.3 * p.y() + 0.4 * p.x())) + slope * p.x();
  }
  TerrainRange range() const {
    return [*this](const Eigen::Vector2d& middle, double half) -> std::optional<HeightRange> {
      HeightRange all{1e9, -1e9};
      const int n = static_cast<int>(std::ceil(half / 0.05));
      for (int i = -n; i <= n; ++i)
        for (int j = -n; j <= n; ++j) {
          const double h = height(middle + Eigen::Vector2d(i, j) * (half / n));
          all.low = std::min(all.low, h), all.high = std::max(all.high, h);
        }
      const double between = 0.05 * (amplitude * 5 + std::abs(slope));
      return HeightRange{all.low - between, all.high + between};
    };
  }
  double amplitude = 0.05, slope = 0;
};

/// Clearance and tilt of the plane through given heights of supports, on a fine grid of the belly.
ClearanceBounds settled(const Waves& terrain, const Pose2& pose, const Vehicle& vehicle,
                        const std::vector<std::size_t>& supports) {
  Eigen::MatrixXd a(static_cast<Eigen::Index>(supports.size()), 3);
  Eigen::VectorXd z(static_cast<Eigen::Index>(supports.size()));
  double front = 0, side = 0;
  for (std::size_t i = 0; i < supports.size(); ++i) {
    const Support& s = vehicle.supports[supports[i]];
    a.row(static_cast<Eigen::Index>(i)) << 1, s.x.value, s.y.value;
    z(static_cast<Eigen::Index>(i)) = terrain.height((pose * Pose2{s.x.value, s.y.value, 0}).at());
  }
  for (const Support& s : vehicle.supports)
    front = std::max(front, std::abs(s.x.value)), side = std::max(side, std::abs(s.y.value));
  const Eigen::Vector3d plane = a.colPivHouseholderQr().solve(z);
  ClearanceBounds real{1e9, std::atan(plane.tail<2>().norm()) * 180 / std::numbers::pi};
  for (double x = -front; x <= front; x += 0.2)
    for (double y = -side; y <= side; y += 0.2)
      real.belly =
          std::min(real.belly, plane.x() + plane.y() * x + plane.z() * y + vehicle.belly_clearance.value -
                                   terrain.height((pose * Pose2{x, y, 0}).at()));
  return real;
}

Vehicle with(const std::string& suspension) {
  Vehicle vehicle = find_vehicle("rover");
  vehicle.suspension = suspension;
  if (suspension == "rigid")
    vehicle.supports.erase(vehicle.supports.begin() + 2, vehicle.supports.begin() + 4);
  return vehicle;
}

TEST(Clearance, LevelTerrainLeavesTheBellysHeight) {
  const Waves level{.amplitude = 0};
  for (const char* suspension : {"rigid", "rocker_bogie"}) {
    const auto bounds = clearance_bounds({1, 2, 0.3}, with(suspension), level.range(), 0, 0);
    ASSERT_TRUE(bounds);
    EXPECT_NEAR(bounds->belly, 0.6, 1e-9);
    EXPECT_NEAR(bounds->tilt, 0, 1e-9);
    // Errors of the heights act at wheels and belly.
    const auto rough = clearance_bounds({1, 2, 0.3}, with(suspension), level.range(), 0, 0.05);
    EXPECT_LE(rough->belly, 0.5 + 1e-9);
  }
}

TEST(Clearance, BoundsHoldForEveryPoseAndHeightWithinTheErrors) {
  Random random(3);
  double slack = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Waves terrain{.amplitude = random.uniform(0, 0.12), .slope = random.uniform(-0.2, 0.2)};
    const Vehicle vehicle = with(trial % 2 ? "rigid" : "rocker_bogie");
    const Pose2 pose{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-3, 3)};
    const double error = trial % 3 * 0.1;
    const auto bounds = clearance_bounds(pose, vehicle, terrain.range(), error, 0);
    ASSERT_TRUE(bounds);
    for (int k = 0; k < 20; ++k) {
      const double r = error * random.uniform(), a = random.uniform(-3.1, 3.1);
      const Pose2 real{pose.x + r * std::cos(a), pose.y + r * std::sin(a), pose.yaw};
      // On a rigid body, the diagonals of four wheels split it into the triangles that hold the middle.
      std::vector<std::vector<std::size_t>> stands;
      if (vehicle.suspension == "rigid")
        stands = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
      else
        stands = {{0, 1, 2, 3, 4, 5}};
      for (const auto& stand : stands) {
        const ClearanceBounds found = settled(terrain, real, vehicle, stand);
        ASSERT_GE(found.belly, bounds->belly - 1e-9) << "trial " << trial;
        ASSERT_LE(found.tilt, bounds->tilt + 1e-9) << "trial " << trial;
        slack = std::max(slack, found.belly - bounds->belly);
      }
    }
  }
  EXPECT_LT(slack, 1.2);  // a bound that is never near would be useless
}

TEST(Clearance, UnknownTerrainHasNoBound) {
  const TerrainRange unknown = [](const Eigen::Vector2d&, double) { return std::optional<HeightRange>(); };
  EXPECT_FALSE(clearance_bounds({}, with("rigid"), unknown, 0, 0));
}

}  // namespace
}  // namespace waymark::test
