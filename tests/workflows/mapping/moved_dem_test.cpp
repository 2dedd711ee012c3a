// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/moved_dem.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
namespace {

using workflows::MapMove;

// A plane stays a plane: its heights at moved places are known exactly.
double plane(double x, double y) {
  return 100 + 0.3 * x - 0.2 * y;
}

std::shared_ptr<const DemSource> made_plane() {
  Grid<double> heights(40, 30);
  const Georeference where{.crs = Crs::local(), .x0 = -50, .y0 = 20, .dx = 3, .dy = -3};
  for (std::int64_t r = 0; r < 30; ++r)
    for (std::int64_t c = 0; c < 40; ++c) heights(c, r) = plane(where.x(double(c)), where.y(double(r)));
  heights(20, 15) = kNoHeight;
  return std::make_shared<MemoryDem>(heights, where);
}

TEST(MovedDem, HeightsAreThoseOfTheMovedPlaces) {
  const auto dem = made_plane();
  Random random(3, "moved dem");
  for (int trial = 0; trial < 20; ++trial) {
    MapMove move{.lift = random.uniform(-50, 50)};
    move.plane = {.log_scale = random.uniform(-0.7, 0.7),
                  .yaw = random.uniform(-3.2, 3.2),
                  .shift = {random.uniform(-1e3, 1e3), random.uniform(-1e3, 1e3)}};
    const auto moved = workflows::moved_dem(dem, move, Crs::local());
    const GridGeometry& grid = moved->geometry();
    const HeightWindow all = moved->read({0, 0, grid.columns, grid.rows});
    std::int64_t known = 0;
    for (std::int64_t r = 0; r < grid.rows; ++r)
      for (std::int64_t c = 0; c < grid.columns; ++c) {
        if (!std::isfinite(all(c, r))) continue;
        ++known;
        const Eigen::Vector2d at(grid.where.x(double(c)), grid.where.y(double(r)));
        const Eigen::Vector2d there = move.plane.linear().inverse() * (at - move.plane.shift);
        ASSERT_NEAR(all(c, r), std::exp(move.plane.log_scale) * plane(there.x(), there.y()) + move.lift,
                    1e-6);
      }
    EXPECT_GT(known, 1000) << "of 39 x 29 cells, less four beside the unknown one";
    // by pieces, also ones that reach beyond the grid
    for (int piece = 0; piece < 5; ++piece) {
      const Window window{std::int64_t(random.uniform(-10, 40)), std::int64_t(random.uniform(-10, 40)), 17,
                          9};
      const HeightWindow part = moved->read(window);
      for (std::int64_t r = 0; r < window.rows; ++r)
        for (std::int64_t c = 0; c < window.columns; ++c) {
          const std::int64_t x = window.column + c, y = window.row + r;
          const bool inside = x >= 0 && y >= 0 && x < grid.columns && y < grid.rows;
          ASSERT_EQ(part(c, r), inside ? all(x, y) : kNoHeight);
        }
    }
  }
}

}  // namespace
}  // namespace waymark::test
