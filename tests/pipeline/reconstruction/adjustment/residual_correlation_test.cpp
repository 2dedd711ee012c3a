// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/residual_correlation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/random.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

Grid<float> white(std::int64_t size, std::uint64_t seed) {
  Random random(seed, "residuals");
  Grid<float> out(size, size);
  for (std::int64_t r = 0; r < size; ++r)
    for (std::int64_t c = 0; c < size; ++c) out(c, r) = float(random.normal());
  return out;
}

// Each cell the mean of a square of 2 k + 1 cells: the correlation falls linearly to 0 at 2 k + 1 cells, and
// (2 k + 1)^2 cells share one error.
Grid<float> boxes(std::int64_t size, int k, std::uint64_t seed) {
  const Grid<float> from = white(size + 2 * k, seed);
  Grid<float> out(size, size, 0.0F);
  for (std::int64_t r = 0; r < size; ++r)
    for (std::int64_t c = 0; c < size; ++c)
      for (int y = 0; y <= 2 * k; ++y)
        for (int x = 0; x <= 2 * k; ++x) out(c, r) += from(c + x, r + y) / float(2 * k + 1);
  return out;
}

TEST(ResidualCorrelation, IndependentCellsShareNothing) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Grid<float> cells = white(100, seed);
    EXPECT_EQ(correlation_of(cells, 10).by_lag.size(), 1U);
    EXPECT_EQ(correlation_of(cells, 10).shared_cells(cells), 1);
  }
}

TEST(ResidualCorrelation, IsThatOfAveragedCells) {
  const Grid<float> cells = boxes(200, 3, 4);
  const ResidualCorrelation found = correlation_of(cells, 10);
  for (int lag = 1; lag < 6; ++lag) EXPECT_NEAR(found.at(lag), 1 - lag / 7.0, 0.08) << lag;
  EXPECT_EQ(found.at(9), 0);
  EXPECT_NEAR(found.shared_cells(cells), 49, 12);  // taken as equal in all directions
}

TEST(ResidualCorrelation, OnlyKnownCellsShare) {
  Grid<float> cells = boxes(200, 3, 5);
  const double all = correlation_of(cells, 10).shared_cells(cells);
  Random random(6, "gaps");
  for (std::int64_t r = 0; r < 200; ++r)
    for (std::int64_t c = 0; c < 200; ++c)
      if (random.uniform() < 0.75) cells(c, r) = kUnknown;
  EXPECT_NEAR(correlation_of(cells, 10).shared_cells(cells), all / 4, 0.15 * all / 4 + 1);
}

TEST(ResidualCorrelation, GrossResidualsAreLeftOut) {
  Grid<float> cells = boxes(200, 3, 7);
  const double before = correlation_of(cells, 5).at(2);
  for (std::int64_t i = 0; i < 200; i += 3) cells(i, (7 * i) % 200) = 1e6F;
  EXPECT_NEAR(correlation_of(cells, 5).at(2), before, 0.02);
}

TEST(ResidualCorrelation, NoCellsHaveNone) {
  const Grid<float> cells(20, 20, kUnknown);
  EXPECT_EQ(correlation_of(cells, 1).by_lag.size(), 1U);
  EXPECT_EQ(correlation_of(cells, 1).shared_cells(cells), 1);
}

}  // namespace
}  // namespace waymark::test
