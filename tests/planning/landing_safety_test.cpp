// SPDX-License-Identifier: Apache-2.0
#include "planning/landing_safety.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.hpp"
namespace waymark::test {
using namespace planning;
namespace {

Grid<float> random_safety(std::int64_t columns, std::int64_t rows, std::uint64_t seed) {
  Random random(seed);
  Grid<float> safe(columns, rows);
  for (float& s : safe.cells())
    s = random.bernoulli(0.05) ? std::numeric_limits<float>::quiet_NaN()
                               : static_cast<float>(random.bernoulli(0.3) ? 0 : random.uniform());
  return safe;
}

Window inner_of(const Eigen::Matrix2d& covariance, std::int64_t columns, std::int64_t rows) {
  const LandingMargin margin = landing_margin(covariance);
  return {margin.columns, margin.rows, columns, rows};
}

Grid<float> safety_about(const Window& inner, std::uint64_t seed) {
  return random_safety(inner.columns + 2 * inner.column, inner.rows + 2 * inner.row, seed);
}

TEST(LandingSafety, TheFastBlurIsTheSumOverAllOffsets) {
  std::uint64_t seed = 1;
  for (const LandingError error :
       {LandingError{4, 4, 0}, LandingError{9, 4, 90}, LandingError{9, 4, 0}, LandingError{8, 4, 35},
        LandingError{8, 5, -60}, LandingError{6, 0.5, 45}}) {
    const Eigen::Matrix2d covariance = covariance_in_cells(error, 1, 1.25);
    const Window inner = inner_of(covariance, 12, 10);
    const Grid<float> safe = safety_about(inner, seed++);
    const Grid<float> fast = landing_safety(safe, inner, covariance),
                      slow = landing_safety_directly(safe, inner, covariance);
    for (std::size_t i = 0; i < fast.cells().size(); ++i)
      ASSERT_NEAR(fast.cells()[i], slow.cells()[i], 0.005) << error.major << " " << error.azimuth;
  }
}

TEST(LandingSafety, AnAzimuthIsClockwiseFromNorth) {
  // A safe strip to the north-east and south-west: only an ellipse along it lands on it.
  const auto strip = [](double azimuth) {
    const Eigen::Matrix2d covariance = covariance_in_cells({10, 1, azimuth}, 1, 1);
    const Window inner = inner_of(covariance, 1, 1);
    Grid<float> safe(2 * inner.column + 1, 2 * inner.row + 1, 0);
    for (std::int64_t r = 0; r < safe.rows(); ++r)
      for (std::int64_t c = 0; c < safe.columns(); ++c)
        if (std::abs((c - inner.column) + (r - inner.row)) <= 6) safe(c, r) = 1;
    return landing_safety(safe, inner, covariance)(0, 0);
  };
  EXPECT_GT(strip(45), 0.99F);
  EXPECT_LT(strip(-45), 0.5F);
}

TEST(LandingSafety, SafeTerrainIsSafeAndTheUnknownIsNot) {
  const Eigen::Matrix2d covariance = covariance_in_cells({5, 4, 20}, 1, 1);
  const Window inner = inner_of(covariance, 3, 3);
  Grid<float> safe(inner.columns + 2 * inner.column, inner.rows + 2 * inner.row, 1);
  EXPECT_NEAR(landing_safety(safe, inner, covariance)(1, 1), 1, 1e-3);
  // Half of the terrain is unknown, and the aim lies on its edge.
  for (std::int64_t r = 0; r < safe.rows(); ++r)
    for (std::int64_t c = 0; c <= inner.column; ++c) safe(c, r) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(landing_safety(safe, inner, covariance)(0, 1), 0.5, 0.06);
}

}  // namespace
}  // namespace waymark::test
