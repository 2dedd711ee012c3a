// SPDX-License-Identifier: Apache-2.0
#include "planning/base_fit.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "core/error.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
namespace {

using namespace planning;

HeightWindow surface(std::int64_t size, const std::function<double(double, double)>& height) {
  HeightWindow heights(size, size);
  for (std::int64_t r = 0; r < size; ++r)
    for (std::int64_t c = 0; c < size; ++c) heights(c, r) = height(double(c), double(-r));
  return heights;
}

Window inner_of(const HeightWindow& heights, const BaseFootprint& base) {
  return {base.half_columns, base.half_rows, heights.columns() - 2 * base.half_columns,
          heights.rows() - 2 * base.half_rows};
}

TEST(BaseFit, PlaneHasItsSlopeAndNoRoughnessOrStep) {
  const BaseFootprint base = make_base_footprint(0.5, 0.5, 2, 0.5);
  // Multiples of the quantum, so that nothing is rounded: 0.25 m and -0.125 m per cell of half a metre.
  const auto heights = surface(20, [](double x, double y) { return 7 + 0.25 * x - 0.125 * y; });
  const Grid<BaseRelief> fit = fit_base(heights, inner_of(heights, base), base);
  for (const BaseRelief& cell : fit.cells()) {
    EXPECT_FLOAT_EQ(cell.gradient_x, 0.5);
    EXPECT_FLOAT_EQ(cell.gradient_y, -0.25);
    EXPECT_FLOAT_EQ(cell.roughness, 0);
    EXPECT_FLOAT_EQ(cell.step, 0);
  }
}

TEST(BaseFit, StepOfACliffIsItsHeightLessThePlanesRise) {
  const BaseFootprint base = make_base_footprint(1, 1, 1, 1);  // 3 x 3 cells
  const auto heights = surface(5, [](double x, double) { return x > 2 ? 8.0 : 0.0; });
  // About column 2: heights 0 0 8 in three rows: gradient 4 per cell, steps 8 - 4.
  const BaseRelief cell = fit_base(heights, {2, 2, 1, 1}, base)(0, 0);
  EXPECT_FLOAT_EQ(cell.gradient_x, 4);
  EXPECT_FLOAT_EQ(cell.step, 4);
  // Residuals of 8/3 - 4 x: 4/3, -8/3, 4/3 in each row; mean square (2 (4/3)^2 + (8/3)^2) / 3 = 32/9.
  EXPECT_FLOAT_EQ(cell.roughness, static_cast<float>(std::sqrt(32.0 / 9)));
}

TEST(BaseFit, BoxWithAVoidIsUnknown) {
  const BaseFootprint base = make_base_footprint(1, 1, 2, 1);
  HeightWindow heights(11, 11, 3.0);
  heights(5, 5) = kNoHeight;
  const Window inner = inner_of(heights, base);
  const Grid<BaseRelief> fit = fit_base(heights, inner, base);
  for (std::int64_t r = 0; r < fit.rows(); ++r)
    for (std::int64_t c = 0; c < fit.columns(); ++c)
      EXPECT_EQ(std::isnan(fit(c, r).step), std::max(std::abs(c + 2 - 5), std::abs(r + 2 - 5)) <= 2);
}

TEST(BaseFit, EqualsTheDirectFit) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (unsigned seed = 0; seed < 60; ++seed) {
    const double cell_x = 0.1 + uniform(random), cell_y = seed % 3 ? cell_x : 0.1 + uniform(random);
    const BaseFootprint base =
        make_base_footprint(cell_x, cell_y, 4 * uniform(random), 1.5 * uniform(random));
    HeightWindow heights = random_terrain(seed, 60, 60);
    const double datum = seed % 2 ? 20000 : -9000, scale = seed % 5 ? 0.1 : 300;  // 300: cliffs of 9 km
    for (double& h : heights.cells())
      if (h > kNoHeight) h = datum + scale * (h + 0.3 * uniform(random));
    const Window inner = inner_of(heights, base);
    const Grid<BaseRelief> fit = fit_base(heights, inner, base);
    for (std::int64_t r = 0; r < inner.rows; ++r)
      for (std::int64_t c = 0; c < inner.columns; ++c) {
        const BaseRelief direct = fit_base_directly(heights, inner.column + c, inner.row + r, base);
        const BaseRelief& fast = fit(c, r);
        ASSERT_EQ(std::isnan(fast.step), std::isnan(direct.step)) << "seed " << seed;
        if (std::isnan(direct.step)) continue;
        // The roughness is a difference of squares: relative to the relief, not to itself.
        const double relief = 1e-5 * (std::abs(direct.step) + 1);
        ASSERT_NEAR(fast.gradient_x, direct.gradient_x, 1e-6 * (1 + std::abs(direct.gradient_x)));
        ASSERT_NEAR(fast.gradient_y, direct.gradient_y, 1e-6 * (1 + std::abs(direct.gradient_y)));
        ASSERT_NEAR(fast.roughness, direct.roughness, relief) << "seed " << seed;
        ASSERT_NEAR(fast.step, direct.step, relief) << "seed " << seed;
      }
  }
}

TEST(BaseFit, CellsDoNotDependOnTheWindow) {
  const BaseFootprint base = make_base_footprint(0.3, 0.3, 1.3, 0.4);
  HeightWindow heights = random_terrain(2, 70, 70);
  for (double& h : heights.cells())
    if (h > kNoHeight) h = -4000 + h * 0.0371;
  const std::int64_t m = base.half_columns;
  const Grid<BaseRelief> whole = fit_base(heights, inner_of(heights, base), base);
  for (std::int64_t row = m; row + 13 + m <= 70; row += 13)
    for (std::int64_t column = m; column + 7 + m <= 70; column += 7) {
      HeightWindow part(7 + 2 * m, 13 + 2 * m);
      for (std::int64_t r = 0; r < part.rows(); ++r)
        for (std::int64_t c = 0; c < part.columns(); ++c) part(c, r) = heights(column - m + c, row - m + r);
      const Grid<BaseRelief> fit = fit_base(part, {m, m, 7, 13}, base);
      for (std::int64_t r = 0; r < 13; ++r)
        for (std::int64_t c = 0; c < 7; ++c) {
          const BaseRelief &a = fit(c, r), &b = whole(column + c - m, row + r - m);
          ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0) << column + c << " " << row + r;
        }
    }
}

TEST(BaseFit, BaseOfTooManyCellsIsRefused) {
  EXPECT_THROW(make_base_footprint(0.01, 0.01, 3, 0.3), Error);
}

}  // namespace
}  // namespace waymark::test
