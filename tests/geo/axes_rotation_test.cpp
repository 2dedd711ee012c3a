// SPDX-License-Identifier: Apache-2.0
#include "geo/axes_rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.hpp"

namespace waymark::test {
namespace {

constexpr double kOneDegree = kRadiansPerDegree;

double rotation_at(const char* from_text, const char* to_text, double longitude, double latitude) {
  const Crs from = Crs::from_text(from_text), to = Crs::from_text(to_text);
  const auto at = CrsTransform(geographic_crs(from), from)(longitude, latitude);
  return axes_rotation(CrsTransform(from, to), from, to, at.x, at.y);
}

TEST(AxesRotation, FromDegreesIsTheConvergenceOfMeridians) {
  // Transverse Mercator: tan(convergence) = tan(longitude - central meridian) sin(latitude).
  const double expected = std::atan(std::tan(3 * kOneDegree) * std::sin(60 * kOneDegree));
  EXPECT_NEAR(rotation_at("EPSG:4326", "EPSG:32632", 12, 60), expected, 2e-5);
  EXPECT_NEAR(rotation_at("EPSG:4326", "EPSG:32632", 6, 60), -expected, 2e-5);
  EXPECT_NEAR(rotation_at("EPSG:32632", "EPSG:4326", 12, 60), -expected, 2e-5);
}

TEST(AxesRotation, BetweenZonesIsTheDifferenceOfTheirConvergences) {
  const double left = rotation_at("EPSG:4326", "EPSG:32632", 12, 60);
  const double right = rotation_at("EPSG:4326", "EPSG:32633", 12, 60);
  EXPECT_NEAR(rotation_at("EPSG:32632", "EPSG:32633", 12, 60), right - left, 1e-7);
}

TEST(AxesRotation, OfAPolarMapIsAnyAngle) {
  // South polar stereographic: x = r sin(longitude), y = r cos(longitude), so east is -y at 90 degrees.
  EXPECT_NEAR(rotation_at("IAU_2015:30100", "IAU_2015:30135", 90, -89), -90 * kOneDegree, 1e-8);
  EXPECT_NEAR(rotation_at("IAU_2015:30100", "IAU_2015:30135", -135, -88), 135 * kOneDegree, 1e-8);
  EXPECT_NEAR(std::abs(rotation_at("IAU_2015:30100", "IAU_2015:30135", 180, -85)), 180 * kOneDegree, 1e-8);
}

TEST(AxesRotation, BetweenDegreesIsNone) {
  EXPECT_NEAR(rotation_at("EPSG:4326", "EPSG:4258", 180, 47), 0, 1e-6);
}

LocalFrame frame_at(const char* crs, double longitude, double latitude) {
  const Crs of_map = Crs::from_text(crs);
  const auto [x, y] = CrsTransform(geographic_crs(of_map), of_map)(longitude, latitude);
  return {of_map, {{x, y, 0}}};
}

TEST(GridRotation, IsTheConvergenceOfMeridians) {
  // Transverse Mercator: tan(convergence) = tan(longitude - central meridian) sin(latitude).
  const double expected = std::atan(std::tan(3 * kOneDegree) * std::sin(60 * kOneDegree));
  EXPECT_NEAR(grid_rotation(frame_at("EPSG:32632", 12, 60), {0, 0}), expected, 2e-5);
  EXPECT_NEAR(grid_rotation(frame_at("EPSG:32632", 6, 60), {0, 0}), -expected, 2e-5);
  EXPECT_NEAR(grid_rotation(frame_at("EPSG:32632", 9, 60), {0, 0}), 0, 1e-8);
}

TEST(GridRotation, OfAPolarMapIsAnyAngle) {
  // South polar stereographic: x = r sin(longitude), y = r cos(longitude), so east is -y at 90 degrees.
  EXPECT_NEAR(grid_rotation(frame_at("IAU_2015:30135", 90, -89), {0, 0}), -90 * kOneDegree, 1e-8);
  EXPECT_NEAR(grid_rotation(frame_at("IAU_2015:30135", -135, -88), {0, 0}), 135 * kOneDegree, 1e-8);
}

TEST(GridRotation, InDegreesIsAgainstEastAtThePosition) {
  const LocalFrame frame = frame_at("EPSG:4326", 180, 60);
  EXPECT_NEAR(grid_rotation(frame, {0, 0}), 0, 1e-8);
  // The axis to the east leaves the parallel for the south by distance / radius tan(latitude).
  EXPECT_NEAR(grid_rotation(frame, {10e3, 0}), -10e3 / 6.394e6 * std::tan(60 * kOneDegree), 2e-6);
}

TEST(GridRotation, OfALocalMapIsNone) {
  EXPECT_EQ(grid_rotation(LocalFrame(Crs::local(), {{5, 6, 0}}), {100, 100}), 0);
}

}  // namespace
}  // namespace waymark::test
