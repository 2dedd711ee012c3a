// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/refine_heights.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/random.hpp"
#include "tests/pipeline/reconstruction/made_views.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr float kNoCell = std::numeric_limits<float>::quiet_NaN();

// Terrain of a site on a grid of 48 x 48 cells of 0.86 m, seen by five views.
class RefineHeights : public ::testing::Test {
 protected:
  RefineHeights()
      : scene_(made_site(5)),
        views_(made_flight(scene_)),
        images_(views_, std::size_t{1} << 30),
        used_(views_.size()),
        truth_(grid_.columns, grid_.rows),
        sd_(grid_.columns, grid_.rows, 0.3f) {
    std::iota(used_.begin(), used_.end(), std::size_t{0});
    for (std::int64_t r = 0; r < grid_.rows; ++r)
      for (std::int64_t c = 0; c < grid_.columns; ++c)
        truth_(c, r) = static_cast<float>(
            scene_.terrain.height(grid_.x(static_cast<double>(c)), grid_.y(static_cast<double>(r))).value());
  }

  std::vector<RefinedHeight> refined(const Grid<float>& heights, const Window& window) {
    const ViewsAt views = [this](std::int64_t, std::int64_t) {
      return ComparedViews{views_, images_, used_, 25 * std::numbers::pi / 180};
    };
    return refine_heights(heights, sd_, grid_, window, 16, views, {});
  }

  Grid<float> noisy() const {
    Random random(3);
    Grid<float> heights = truth_;
    for (float& h : heights.cells()) h += 0.3f * static_cast<float>(random.normal());
    return heights;
  }

  double rms(const std::vector<RefinedHeight>& cells) const {
    double squares = 0;
    for (std::size_t i = 0; i < cells.size(); ++i)
      squares += std::pow(static_cast<double>(cells[i].height - truth_.cells()[i]), 2);
    return std::sqrt(squares / static_cast<double>(cells.size()));
  }

  const SurfaceGrid grid_{.west = -20.64, .north = 20.64, .cell = 0.86, .columns = 48, .rows = 48};
  const testbed::Scene scene_;
  const std::vector<SurfaceView> views_;
  ImageLevels images_;
  std::vector<std::size_t> used_;
  Grid<float> truth_, sd_;
};

// An error of 0.2 pixels of parallax is 0.18 m at 25 degrees.
TEST_F(RefineHeights, ImagesGiveTheHeightsThatNoiseHides) {
  EXPECT_LT(rms(refined(noisy(), {0, 0, 48, 48})), 0.18);
}

TEST_F(RefineHeights, AShiftedSurfaceReturns) {
  Grid<float> raised = truth_;
  for (float& h : raised.cells()) h += 0.4f;
  EXPECT_LT(rms(refined(raised, {0, 0, 48, 48})), 0.18);
}

TEST_F(RefineHeights, StatedDeviationsAreThoseOfTheErrors) {
  const std::vector<RefinedHeight> cells = refined(noisy(), {0, 0, 48, 48});
  double z = 0;
  for (std::size_t i = 0; i < cells.size(); ++i)
    z += std::pow(static_cast<double>(cells[i].height - truth_.cells()[i]) / static_cast<double>(cells[i].sd),
                  2);
  z /= static_cast<double>(cells.size());
  EXPECT_GT(z, 0.3);
  EXPECT_LT(z, 1.5);
}

TEST_F(RefineHeights, CellsWithoutHeightStaySo) {
  Grid<float> heights = noisy();
  for (std::int64_t r = 10; r < 20; ++r)
    for (std::int64_t c = 10; c < 40; ++c) heights(c, r) = kNoCell;
  const std::vector<RefinedHeight> cells = refined(heights, {0, 0, 48, 48});
  for (std::size_t i = 0; i < cells.size(); ++i)
    EXPECT_EQ(std::isnan(cells[i].height), std::isnan(heights.cells()[i]));
}

TEST_F(RefineHeights, TheDivisionIntoWindowsDoesNotMatter) {
  const Grid<float> heights = noisy();
  const std::vector<RefinedHeight> all = refined(heights, {0, 0, 48, 48});
  for (std::int64_t r0 = 0; r0 < 48; r0 += 16)
    for (std::int64_t c0 = 0; c0 < 48; c0 += 16) {
      const std::vector<RefinedHeight> part = refined(heights, {c0, r0, 16, 16});
      for (std::int64_t n = 0; n < 256; ++n) {
        const RefinedHeight &a = part[static_cast<std::size_t>(n)],
                            &b = all[static_cast<std::size_t>((r0 + n / 16) * 48 + c0 + n % 16)];
        ASSERT_EQ(a.height, b.height);
        ASSERT_EQ(a.sd, b.sd);
      }
    }
}

TEST_F(RefineHeights, OneViewLeavesHeightsAsTheyAre) {
  used_.resize(1);
  const Grid<float> heights = noisy();
  const std::vector<RefinedHeight> cells = refined(heights, {0, 0, 48, 48});
  for (std::size_t i = 0; i < cells.size(); ++i) ASSERT_EQ(cells[i].height, heights.cells()[i]);
}

}  // namespace
}  // namespace waymark::test
