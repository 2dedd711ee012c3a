// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include "geo/terrain.hpp"
#include "testbed/landing/rock_solid.hpp"
namespace waymark::test {

/// Returns a plane through the origin, 60 m wide, that rises by `east` and `north` metres per metre.
inline Terrain plane(double east, double north) {
  constexpr int kNodes = 61, kHalf = 30;
  Grid<float> heights(kNodes, kNodes);
  for (int row = 0; row < kNodes; ++row)
    for (int column = 0; column < kNodes; ++column)
      heights(column, row) = static_cast<float>(east * (column - kHalf) + north * (kHalf - row));
  return {std::move(heights), -kHalf, kHalf, 1, 1};
}

/// Returns a round rock: `radius` metres wide on the ground, `top` metres high.
inline testbed::RockSolid rock_at(const Eigen::Vector3d& foot, double radius, double top,
                                  testbed::RockShape shape = testbed::RockShape::ellipsoid) {
  return {.shape = shape,
          .foot = foot,
          .half_x = radius,
          .half_y = radius,
          .top = top,
          .reach = std::hypot(radius, top) + 0.01,
          .planes = {}};
}

}  // namespace waymark::test
