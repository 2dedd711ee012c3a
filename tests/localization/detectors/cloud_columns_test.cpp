// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_columns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace waymark::test {
using namespace localization;
namespace {

constexpr double kStep = 0.007;  // rad between columns

TEST(CloudColumns, AreThatFarApartInAnyOrder) {
  PointCloud cloud;
  std::mt19937 random(1);
  for (int row = -20; row < 10; ++row)
    for (double azimuth = -3.1 + 1e-4 * row; azimuth < 3.1; azimuth += kStep) {
      const double up = 0.0105 * row;  // rad
      cloud.points.emplace_back((10 * Eigen::Vector3d(std::cos(up) * std::cos(azimuth),
                                                      std::cos(up) * std::sin(azimuth), std::sin(up)))
                                    .cast<float>());
    }
  cloud.points.emplace_back(std::nanf(""), 1.0F, 1.0F);
  EXPECT_NEAR(column_step(cloud), kStep, 1e-5);
  std::ranges::shuffle(cloud.points, random);
  EXPECT_NEAR(column_step(cloud), kStep, 1e-5);
  EXPECT_EQ(column_step({}), 0);
}

}  // namespace
}  // namespace waymark::test
