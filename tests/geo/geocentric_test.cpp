// SPDX-License-Identifier: Apache-2.0
#include "geo/geocentric.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace waymark::test {
namespace {

TEST(Geocentric, IsTheInverseOfGeodetic) {
  Random random(9, "geocentric");
  for (const Body& body : {earth(), moon(), mars()})
    for (int i = 0; i < 100; ++i) {
      const Geodetic made{{random.uniform(-180, 180), random.uniform(-90, 90)}, random.uniform(-5e3, 1e6)};
      const Geodetic found = geodetic(body, geocentric(body, made));
      EXPECT_NEAR(found.at.lon, made.at.lon, 1e-9);
      EXPECT_NEAR(found.at.lat, made.at.lat, 1e-11);
      EXPECT_NEAR(found.height, made.height, 1e-8);
    }
}

TEST(Geocentric, PutsThePoleAndTheMeridianWhereTheyAre) {
  EXPECT_LT((geocentric(earth(), {{0, 0}, 100}) - Eigen::Vector3d(6'378'237, 0, 0)).norm(), 1e-6);
  EXPECT_LT((geocentric(mars(), {{30, 90}, 0}) - Eigen::Vector3d(0, 0, 3'376'200)).norm(), 1e-6);
  // The vertical of the ellipsoid, not the direction from the centre.
  const Geodetic there = geodetic(earth(), {4'000'000, 0, 5'000'000});
  EXPECT_GT(there.at.lat, std::atan2(5, 4) * 180 / M_PI + 0.1);
}

}  // namespace
}  // namespace waymark::test
