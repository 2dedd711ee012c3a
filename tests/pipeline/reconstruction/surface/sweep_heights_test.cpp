// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/sweep_heights.hpp"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/reconstruction/surface/orthophoto.hpp"
#include "tests/pipeline/reconstruction/made_views.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

SweepPlan plan_of(const std::vector<SurfaceView>& views) {
  SweepPlan plan;
  plan.range = {-8, 8};
  plan.grid = *overlap_grid(views, plan.range, 0.86);
  return plan;
}

struct HeightErrors {
  double nmad = 0, rmse = 0, bad = 0, z_variance = 0, kept = 0;
};

// Against the mean of the terrain in each cell; in ground sample distances of 0.43 m.
HeightErrors errors_of(const SurfaceHeights& dem, const Terrain& truth) {
  std::vector<double> errors;
  double squares = 0, z = 0, bad = 0;
  for (std::int64_t r = 0; r < dem.grid.rows; ++r)
    for (std::int64_t c = 0; c < dem.grid.columns; ++c) {
      if (dem.reason(c, r) != 0) continue;
      double sum = 0;
      for (int k = 0; k < 16; ++k)
        sum +=
            truth.height(dem.grid.x(double(c) + (k % 4 - 1.5) / 4), dem.grid.y(double(r) + (k / 4 - 1.5) / 4))
                .value() /
            16;
      const double e = (static_cast<double>(dem.height(c, r)) - sum);
      errors.push_back(std::abs(e) / 0.43);
      squares += e * e / 0.43 / 0.43;
      z += std::pow(e / static_cast<double>(dem.sd(c, r)), 2);
      bad += std::abs(e) > 5 * 0.43;
    }
  const auto n = static_cast<double>(errors.size());
  std::ranges::nth_element(errors, errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2));
  return {1.4826 * errors[errors.size() / 2], std::sqrt(squares / n), bad / n, z / n,
          n / static_cast<double>(dem.grid.columns * dem.grid.rows)};
}

bool same_bytes(const SurfaceHeights& a, const SurfaceHeights& b) {
  const auto same = [](const Grid<float>& p, const Grid<float>& q) {
    return std::ranges::equal(p.cells(), q.cells(),
                              [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
  };
  return same(a.height, b.height) && same(a.sd, b.sd) && same(a.systematic_sd, b.systematic_sd) &&
         same(a.angle, b.angle) && same(a.score, b.score) && a.views == b.views && a.reason == b.reason;
}

class SweepHeights : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = new testbed::Scene(made_site(5));
    views_ = new std::vector<SurfaceView>(made_flight(*scene_));
    dem_ = new SurfaceHeights(sweep_heights(*views_, plan_of(*views_)));
  }
  static void TearDownTestSuite() {
    delete dem_;
    delete views_;
    delete scene_;
  }
  static testbed::Scene* scene_;
  static std::vector<SurfaceView>* views_;
  static SurfaceHeights* dem_;
};
testbed::Scene* SweepHeights::scene_ = nullptr;
std::vector<SurfaceView>* SweepHeights::views_ = nullptr;
SurfaceHeights* SweepHeights::dem_ = nullptr;

TEST_F(SweepHeights, AgreeWithTheTestbed) {
  const HeightErrors errors = errors_of(*dem_, scene_->terrain);
  EXPECT_LT(errors.nmad, 0.7);
  EXPECT_LT(errors.rmse, 1.5);
  EXPECT_LT(errors.bad, 0.01);
  EXPECT_GT(errors.kept, 0.5);  // the border is seen once
}

TEST_F(SweepHeights, EveryCellIsMeasuredOrHasAReason) {
  EXPECT_EQ(std::accumulate(dem_->counts.begin(), dem_->counts.end(), std::int64_t{0}),
            dem_->grid.columns * dem_->grid.rows);
  for (std::size_t i = 0; i < dem_->reason.cells().size(); ++i) {
    const bool known = dem_->reason.cells()[i] == 0;
    EXPECT_EQ(known, !std::isnan(dem_->height.cells()[i]));
    EXPECT_EQ(known, !std::isnan(dem_->sd.cells()[i]));
    EXPECT_EQ(known, dem_->views.cells()[i] >= 2);
  }
}

TEST_F(SweepHeights, DoNotDependOnThreadsMemoryOrTheOrderOfImages) {
  ImageSet shuffled;
  for (const std::size_t i : {3u, 1u, 4u, 0u, 2u}) shuffled.push_back((*views_)[i].image);
  const std::vector<SurfaceView> views = surface_views(shuffled);
  SweepPlan plan = plan_of(views);
  plan.image_bytes = 1;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_TRUE(same_bytes(sweep_heights(views, plan), *dem_));
}

// A chunk is computed from its own nodes and their surroundings alone.
TEST_F(SweepHeights, AChunkAloneIsTheChunkOfTheWhole) {
  ImageLevels images(*views_, std::size_t{1} << 30);
  const SurfaceGrid grid{.west = -80, .north = 80, .cell = 0.3, .columns = 533, .rows = 533};
  const Grid<float> base(grid.columns, grid.rows, 0.5f);
  Grid<float> other = base;  // another terrain beyond the halo
  for (std::int64_t r = 0; r < grid.rows; ++r)
    for (std::int64_t c = kChunk + kChunkHalo + 4; c < grid.columns; ++c) other(c, r) = 4;
  const SweepRules rules;
  const SweepPass pass{.views = *views_, .images = images, .rules = rules, .grid = grid, .base = base};
  const SweepPass changed{.views = *views_, .images = images, .rules = rules, .grid = grid, .base = other};
  const ChunkHeights a = sweep_chunk(pass, 0, kChunk), b = sweep_chunk(changed, 0, kChunk);
  ASSERT_EQ(a.reason, b.reason);
  for (std::size_t i = 0; i < a.height.size(); ++i) {
    if (a.reason[i] == NoHeight::none) {
      EXPECT_EQ(a.height[i], b.height[i]);
    }
  }
}

TEST_F(SweepHeights, ACoarseDemStartsTheSearch) {
  SweepPlan plan = plan_of(*views_);
  const SurfaceGrid coarse{.west = -70, .north = 70, .cell = 10, .columns = 14, .rows = 14};
  Grid<float> heights(14, 14);
  for (std::int64_t r = 0; r < 14; ++r)
    for (std::int64_t c = 0; c < 14; ++c)
      heights(c, r) =
          static_cast<float>(scene_->terrain.height(coarse.x(double(c)), coarse.y(double(r))).value());
  plan.coarse = CoarseHeights{.grid = coarse, .heights = heights, .sd = 1};
  const HeightErrors errors = errors_of(sweep_heights(*views_, plan), scene_->terrain);
  EXPECT_LT(errors.nmad, 0.7);
}

TEST_F(SweepHeights, TheRangeIsFoundFromTheImagesAlone) {
  ImageLevels images(*views_, std::size_t{1} << 30);
  const auto range = height_range(probe_heights(*views_, images));
  ASSERT_TRUE(range);
  EXPECT_LT(range->low, scene_->terrain.height(0, 0).value());
  EXPECT_GT(range->high, scene_->terrain.height(0, 0).value());
  EXPECT_LT(range->high - range->low, 40);
}

TEST_F(SweepHeights, ErrorsOfPosesShowInTheirBandAlone) {
  std::vector<SurfaceView> uncertain = *views_;
  for (SurfaceView& view : uncertain) view.view.covariance.diagonal().tail<3>().setConstant(0.01);  // 0.1 m
  const SurfaceHeights dem = sweep_heights(uncertain, plan_of(uncertain));
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < dem.height.cells().size(); ++i) {
    if (dem.reason.cells()[i] != 0) continue;
    ASSERT_EQ(dem.height.cells()[i], dem_->height.cells()[i]);
    ASSERT_EQ(dem_->systematic_sd.cells()[i], 0);
    sum += static_cast<double>(dem.systematic_sd.cells()[i]), ++count;
  }
  // Two rays at 20 degrees lift 0.1 m in plan to about 0.1 / tan(20) * sqrt(2) / 2; five views share it.
  EXPECT_GT(sum / count, 0.05);
  EXPECT_LT(sum / count, 0.5);
}

// The testbed renders each row from its own pose by velocity and spin.
TEST_F(SweepHeights, OfARollingShutterAreThoseOfAGlobalOne) {
  const std::vector<SurfaceView> moving = made_flight(*scene_, 0.1);
  std::vector<SurfaceView> held = moving;
  for (SurfaceView& view : held) view.view.motion.reset();
  const HeightErrors with = errors_of(sweep_heights(moving, plan_of(moving)), scene_->terrain),
                     without = errors_of(sweep_heights(held, plan_of(held)), scene_->terrain),
                     still = errors_of(*dem_, scene_->terrain);
  std::printf("NMAD %.2f px, RMSE %.2f px; without the motion %.2f, %.2f px; global shutter %.2f, %.2f px\n",
              with.nmad, with.rmse, without.nmad, without.rmse, still.nmad, still.rmse);
  EXPECT_LT(with.nmad, 1.2 * still.nmad);
  EXPECT_LT(with.rmse, 1.3 * still.rmse);
  EXPECT_GT(without.nmad, 2 * with.nmad);
}

TEST_F(SweepHeights, BlackImagesHaveNoHeights) {
  std::vector<SurfaceView> views;
  for (const SurfaceView& view : *views_)
    views.push_back(made_view(view.name, view.view, Pixels(160, 160, 0)));
  const SurfaceHeights dem = sweep_heights(views, plan_of(views));
  EXPECT_EQ(dem.kept(), 0);
  EXPECT_GT(dem.counts[static_cast<std::size_t>(NoHeight::texture)], 0);
}

TEST_F(SweepHeights, CamerasBelowTheTerrainSeeNothing) {
  std::vector<SurfaceView> views = *views_;
  for (SurfaceView& view : views) view.view.grid_from_camera.transform.translation().z() = -40;
  EXPECT_FALSE(overlap_grid(views, {-8, 8}, 0.86));
}

TEST_F(SweepHeights, TheOrthophotoShowsTheTerrainFromAbove) {
  const Orthophoto ortho = make_orthophoto(*views_, dem_->grid, dem_->height, 2, std::size_t{1} << 30);
  const std::int64_t c = ortho.grid.columns / 2, r = ortho.grid.rows / 2;
  testbed::View above{.camera = {},
                      .columns = 100,
                      .rows = 100,
                      .x0 = ortho.grid.x(double(c - 50)),
                      .y0 = ortho.grid.y(double(r - 50)),
                      .gsd = ortho.grid.cell};
  const Pixels map = testbed::render_view(*scene_, above, {}, 1);
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (std::int64_t j = 0; j < 100; ++j)
    for (std::int64_t i = 0; i < 100; ++i) {
      const double x = static_cast<double>(ortho.brightness(c - 50 + i, r - 50 + j)),
                   y = static_cast<double>(map(i, j));
      if (std::isnan(x)) continue;
      EXPECT_NE(ortho.source(c - 50 + i, r - 50 + j), 0);
      ++n, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
    }
  EXPECT_GT(n, 8000);
  EXPECT_GT((ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n)), 0.85);
  for (const double gain : ortho.gains) EXPECT_NEAR(gain, 1, 0.1);
}

}  // namespace
}  // namespace waymark::test
