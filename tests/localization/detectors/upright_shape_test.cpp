// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/upright_shape.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace waymark::test {
using namespace localization;
namespace {

constexpr double kStep = 0.007;  // rad between columns

/// What stands at `at`: a cylinder, or a plate that faces the scanner. One side may be hidden up to an
/// azimuth.
struct Upright {
  Eigen::Vector2d at;
  double radius, low, high;
  bool is_plate = false;
  double hidden = -4;  // rad
};

/// Rows every 0.2 m of height, columns at multiples of kStep from a random one, 2 cm of noise.
std::vector<RaisedPoint> seen(std::vector<Upright> things, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.02);
  const double first = std::uniform_real_distribution<double>(0, kStep)(random);
  std::vector<RaisedPoint> points;
  for (const Upright& thing : things)
    for (double height = thing.low; height < thing.high; height += 0.2)
      for (double azimuth = first - 0.7; azimuth < 0.7; azimuth += kStep) {
        const Eigen::Vector2d ray(std::cos(azimuth), std::sin(azimuth));
        const double off = ray.x() * thing.at.y() - ray.y() * thing.at.x();
        if (std::abs(off) > thing.radius || azimuth < thing.hidden) continue;
        const double behind = thing.is_plate ? 0 : std::sqrt(thing.radius * thing.radius - off * off);
        const double range = ray.dot(thing.at) - behind + noise(random);
        points.push_back({(range * ray).cast<float>(), static_cast<float>(height)});
      }
  return points;
}

struct Errors {
  double range = 0, across = 0, diameter = 0, normalized = 0;
};

Errors mean_errors(const Upright& thing, const std::vector<Upright>& beside = {}) {
  Errors mean;
  constexpr int n = 100;
  for (unsigned seed = 1; seed <= n; ++seed) {
    std::vector<Upright> things = beside;
    things.push_back(thing);
    const auto shape = fit_upright(seen(things, seed), kStep, 0.7);
    if (!shape) {
      ADD_FAILURE() << "seed " << seed;
      continue;
    }
    const Eigen::Vector2d off = shape->axis - thing.at, along = thing.at.normalized();
    mean.range += along.dot(off) / n;
    mean.across += (along.x() * off.y() - along.y() * off.x()) / n;
    mean.diameter += (shape->diameter - 2 * thing.radius) / n;
    mean.normalized += off.dot(shape->covariance.inverse() * off) / 2 / n;
  }
  return mean;
}

// A circle fitted to the arc of a lamp post 10 m away lies 5 cm before its axis.
TEST(UprightShape, HasTheAxisOfThinPolesWithoutBias) {
  for (const double range : {4.0, 8.0, 14.0})
    for (const double radius : {0.06, 0.08, 0.11}) {
      const Errors e = mean_errors({{range, 1}, radius, 0.3, 3});
      const double quantum = range * kStep;
      EXPECT_NEAR(e.range, 0, 0.006 + 0.1 * quantum) << range << " " << radius;
      EXPECT_NEAR(e.across, 0, 0.004) << range << " " << radius;
      EXPECT_NEAR(e.diameter, 0, 0.008 + 0.2 * quantum) << range << " " << radius;
      EXPECT_LT(e.normalized, 1.2) << range << " " << radius;
    }
}

TEST(UprightShape, IsThatOfThePostUnderItsSign) {
  const Errors e = mean_errors({{7, -1}, 0.04, 0.3, 2}, {{{6.9, -1}, 0.3, 2, 2.8, true}});
  EXPECT_NEAR(e.range, 0, 0.02);
  EXPECT_NEAR(e.across, 0, 0.01);
  EXPECT_NEAR(e.diameter, 0, 0.02);
}

TEST(UprightShape, OfAStemDoesNotNeedItsHiddenSide) {
  const double middle = std::atan2(1, 7);
  const Errors e = mean_errors({{7, 1}, 0.25, 1.2, 2.5}, {{{7, 1}, 0.25, 0.3, 1.2, false, middle - 0.005}});
  EXPECT_NEAR(e.range, 0, 0.02);
  EXPECT_NEAR(e.across, 0, 0.02);
  EXPECT_NEAR(e.diameter, 0, 0.03);
}

// Several scans in one cloud see a pole from all sides.
TEST(UprightShape, OfAWholeCircleIsThatCircle) {
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(5.5, 1.9), Eigen::Vector2d(-3.5, -7.1)}) {
    std::vector<RaisedPoint> points;
    for (int layer = 0; layer < 20; ++layer)
      for (int i = 0; i < 8; ++i) {
        const double angle = i * std::numbers::pi / 4;
        points.push_back({(at + 0.1 * Eigen::Vector2d(std::cos(angle), std::sin(angle))).cast<float>(),
                          0.3F + 0.1F * static_cast<float>(layer)});
      }
    for (const double step : {0.0, kStep, 0.02}) {
      const auto shape = fit_upright(points, step, 0.7);
      ASSERT_TRUE(shape);
      EXPECT_LT((shape->axis - at).norm(), 0.01);
      EXPECT_NEAR(shape->diameter, 0.2, 0.01);
    }
  }
}

TEST(UprightShape, IsNoPlateAndNothingWide) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    EXPECT_FALSE(fit_upright(seen({{{8, 0}, 0.3, 0.3, 2, true}}, seed), kStep, 0.7)) << seed;
    EXPECT_FALSE(fit_upright(seen({{{8, 0}, 0.5, 0.3, 2}}, seed), kStep, 0.7)) << seed;
  }
  EXPECT_FALSE(fit_upright({}, kStep, 0.7));
}

}  // namespace
}  // namespace waymark::test
