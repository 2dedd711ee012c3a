// SPDX-License-Identifier: Apache-2.0
#include "geo/grid_rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.hpp"

namespace waymark::test {
namespace {

constexpr double kDegree = kRadiansPerDegree;

LocalFrame frame_at(const char* crs, double longitude, double latitude) {
  const Crs of_map = Crs::from_text(crs);
  const auto [x, y] = CrsTransform(geographic_crs(of_map), of_map)(longitude, latitude);
  return {of_map, {{x, y, 0}}};
}

TEST(GridRotation, IsTheConvergenceOfMeridians) {
  // Transverse Mercator: tan(convergence) = tan(longitude - central meridian) sin(latitude).
  const double expected = std::atan(std::tan(3 * kDegree) * std::sin(60 * kDegree));
  EXPECT_NEAR(grid_rotation(frame_at("EPSG:32632", 12, 60), {0, 0}), expected, 2e-5);
  EXPECT_NEAR(grid_rotation(frame_at("EPSG:32632", 6, 60), {0, 0}), -expected, 2e-5);
  EXPECT_NEAR(grid_rotation(frame_at("EPSG:32632", 9, 60), {0, 0}), 0, 1e-8);
}

TEST(GridRotation, OfAPolarMapIsAnyAngle) {
  // South polar stereographic: x = r sin(longitude), y = r cos(longitude), so east is -y at 90 degrees.
  EXPECT_NEAR(grid_rotation(frame_at("IAU_2015:30135", 90, -89), {0, 0}), -90 * kDegree, 1e-8);
  EXPECT_NEAR(grid_rotation(frame_at("IAU_2015:30135", -135, -88), {0, 0}), 135 * kDegree, 1e-8);
}

TEST(GridRotation, InDegreesIsAgainstEastAtThePosition) {
  const LocalFrame frame = frame_at("EPSG:4326", 180, 60);
  EXPECT_NEAR(grid_rotation(frame, {0, 0}), 0, 1e-8);
  // The axis to the east leaves the parallel for the south by distance / radius tan(latitude).
  EXPECT_NEAR(grid_rotation(frame, {10e3, 0}), -10e3 / 6.394e6 * std::tan(60 * kDegree), 2e-6);
}

TEST(GridRotation, OfALocalMapIsNone) {
  EXPECT_EQ(grid_rotation(LocalFrame(Crs::local(), {{5, 6, 0}}), {100, 100}), 0);
}

}  // namespace
}  // namespace waymark::test
