// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <set>

#include "core/random.hpp"
#include "pipeline/reconstruction/surface/choose_views.hpp"
#include "pipeline/reconstruction/surface/height_checks.hpp"
#include "pipeline/reconstruction/surface/image_levels.hpp"
#include "pipeline/reconstruction/surface/orthophoto.hpp"
#include "pipeline/reconstruction/surface/pose_uncertainty.hpp"
#include "pipeline/reconstruction/surface/surface_grid.hpp"
#include "pipeline/vision/half_image.hpp"
#include "tests/pipeline/reconstruction/made_views.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

std::vector<SurfaceView> row_of_views(int count, double apart) {
  std::vector<SurfaceView> views;
  for (int i = 0; i < count; ++i)
    views.push_back(
        {.name = std::string(1, static_cast<char>('a' + i)), .view = camera_above(i * apart, 0, 100)});
  return views;
}

TEST(ImageLevels, HalvesKeepThePixelConvention) {
  Pixels ramp(8, 8);
  for (std::int64_t r = 0; r < 8; ++r)
    for (std::int64_t c = 0; c < 8; ++c) ramp(c, r) = static_cast<float>(c);
  const Pixels half = half_image(ramp);
  ASSERT_EQ(half.columns(), 4);
  EXPECT_FLOAT_EQ(half(1, 0), 2.5f);  // (1 + 0.5) * 2 - 0.5
}

TEST(ImageLevels, ASmallBudgetChangesNothing) {
  const auto scene = made_site(3);
  const auto views = made_flight(scene);
  ImageLevels rich(views, std::size_t{1} << 30), poor(views, 1);
  for (const int level : {2, 0, 1})
    for (std::size_t v = 0; v < views.size(); ++v)
      EXPECT_EQ(rich.get(v, level)->pixels, poor.get(v, level)->pixels);
}

TEST(ImageLevels, NoiseIsThatOfFlatParts) {
  Random random(4);
  Pixels image(256, 256);
  for (float& value : image.cells()) value = static_cast<float>(100 + 3 * random.normal());
  EXPECT_NEAR(noise_of(image, 0), 3, 0.6);
}

TEST(ChooseViews, AnglesAndPixelSizesAreWithinTheRules) {
  const auto views = row_of_views(12, 8);
  const ViewRules rules;
  const ChosenViews chosen = choose_views(views, {44, 0, 0}, 0.7, 0, rules);
  EXPECT_EQ(chosen.views.size(), rules.max_views);
  EXPECT_EQ(chosen.candidates, 12);
  for (const ViewPair& pair : chosen.pairs) {
    EXPECT_GE(pair.angle * 180 / M_PI, rules.min_angle);
    EXPECT_LE(pair.angle * 180 / M_PI, rules.max_angle);
    EXPECT_GE(pair.angle, rules.min_angle_fraction * chosen.angle);
  }
}

TEST(ChooseViews, AVerticalDescentHasNoPairsBelowTheCameras) {
  std::vector<SurfaceView> views;
  for (int i = 0; i < 4; ++i)
    views.push_back({.name = std::to_string(i), .view = camera_above(0, 0, 100 + 20 * i)});
  EXPECT_TRUE(choose_views(views, {0, 0, 0}, 0.7, 0, {}).pairs.empty());
}

TEST(ChooseViews, SunsThatMovedAreNotCompared) {
  auto views = row_of_views(4, 20);
  for (std::size_t i = 0; i < views.size(); ++i)
    views[i].sun = Sun{.azimuth = Degrees{i < 2 ? 100.0 : 160.0}, .elevation = Degrees{30}};
  const ChosenViews chosen = choose_views(views, {30, 0, 0}, 0.7, 0, {});
  std::set<std::size_t> used(chosen.views.begin(), chosen.views.end());
  EXPECT_TRUE(used == (std::set<std::size_t>{0, 1}) || used == (std::set<std::size_t>{2, 3}));
}

TEST(SurfaceGrid, GapsAreFilledAndTheRestStays) {
  Grid<float> heights(9, 7, 5);
  heights(4, 3) = heights(5, 3) = kNoHeight;
  heights(0, 0) = 9;
  const Grid<float> filled = fill_gaps(heights);
  EXPECT_FLOAT_EQ(filled(4, 3), 5);
  EXPECT_FLOAT_EQ(filled(0, 0), 9);
  const Grid<float> none(4, 4, kNoHeight);
  EXPECT_TRUE(std::isnan(fill_gaps(none)(2, 2)));
}

TEST(SurfaceGrid, ResamplingKeepsAPlane) {
  const SurfaceGrid coarse{.west = -10, .north = 30, .cell = 2, .columns = 12, .rows = 9};
  Grid<float> plane(12, 9);
  for (std::int64_t r = 0; r < 9; ++r)
    for (std::int64_t c = 0; c < 12; ++c)
      plane(c, r) = static_cast<float>(0.5 * coarse.x(double(c)) - 0.25 * coarse.y(double(r)));
  const SurfaceGrid fine = coarse.with_cell(1);
  const Grid<float> out = resample(plane, coarse, fine);
  for (std::int64_t r = 1; r + 1 < fine.rows; ++r)
    for (std::int64_t c = 1; c + 1 < fine.columns; ++c)
      EXPECT_NEAR(static_cast<double>(out(c, r)), 0.5 * fine.x(double(c)) - 0.25 * fine.y(double(r)), 1e-5);
}

TEST(HeightChecks, ASpikeIsOffThePlaneAndACliffIsNot) {
  Grid<float> heights(16, 16, 0), sd(16, 16, 0.1f);
  for (std::int64_t r = 0; r < 16; ++r)
    for (std::int64_t c = 0; c < 16; ++c)
      heights(c, r) = static_cast<float>(0.3 * double(c) + (r < 8 ? 6 : 0));
  heights(4, 3) += 5;
  const Grid<std::uint8_t> off = cells_off_plane(heights, sd, 4);
  int count = 0;
  for (const std::uint8_t cell : off.cells()) count += cell;
  EXPECT_EQ(count, 1);
  EXPECT_EQ(off(4, 3), 1);
}

TEST(HeightChecks, PatchesOfUpTo25CellsAreIslands) {
  Grid<float> heights(20, 20, kNoHeight);
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i) heights(i, j) = 1;                   // 25 cells
  for (int i = 0; i < 13; ++i) heights(i, 10) = heights(i, 11) = 2;  // 26 cells
  const Grid<std::uint8_t> island = cells_of_islands(heights, 25, 1);
  EXPECT_EQ(island(2, 2), 1);
  EXPECT_EQ(island(5, 10), 0);
  EXPECT_EQ(island(10, 2), 0);
}

// Draws poses, intersects the marks again, and compares the spread with the propagated covariance.
TEST(PoseUncertainty, MatchesDrawnPoses) {
  auto views = row_of_views(3, 25);
  Eigen::Matrix<double, 6, 1> sd;
  sd << 1e-3, 2e-3, 1e-3, 0.1, 0.05, 0.2;
  for (SurfaceView& view : views) view.view.covariance = sd.cwiseAbs2().asDiagonal();
  const Eigen::Vector3d point(20, 5, 3);
  const std::vector<std::size_t> used{0, 1, 2};
  const auto covariance = pose_uncertainty(views, used, point);
  ASSERT_TRUE(covariance);

  Random random(7);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 4000;
  for (int n = 0; n < kDraws; ++n) {
    std::vector<PosedCamera> moved;
    for (const SurfaceView& view : views) {
      PosedCamera camera = view.view;
      Eigen::Matrix<double, 6, 1> e;
      for (int i = 0; i < 6; ++i) e[i] = sd[i] * random.normal();
      const Eigen::Vector3d angle = e.head<3>();
      camera.grid_from_camera.transform.linear() =
          camera.grid_from_camera.transform.linear() *
          Eigen::AngleAxisd(angle.norm(), angle.normalized()).toRotationMatrix();
      camera.grid_from_camera.transform.translation() += e.tail<3>();
      moved.push_back(camera);
    }
    Eigen::Vector3d at = point;
    for (int round = 0; round < 2; ++round) {
      Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
      Eigen::Vector3d right = Eigen::Vector3d::Zero();
      for (std::size_t v = 0; v < moved.size(); ++v) {
        const Eigen::Vector2d miss = *project(views[v].view, {point}) - *project(moved[v], {at});
        Eigen::Matrix<double, 2, 3> by_point;
        for (int axis = 0; axis < 3; ++axis)
          by_point.col(axis) = (*project(moved[v], {at + 0.01 * Eigen::Vector3d::Unit(axis)}) -
                                *project(moved[v], {at - 0.01 * Eigen::Vector3d::Unit(axis)})) /
                               0.02;
        normal += by_point.transpose() * by_point;
        right += by_point.transpose() * miss;
      }
      at += normal.inverse() * right;
    }
    spread += (at - point) * (at - point).transpose() / kDraws;
  }
  // 4000 draws give a variance within 2.2 % (one sigma); 10 % is beyond four.
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(spread(axis, axis) / (*covariance)(axis, axis), 1, 0.1);
}

TEST(BalanceGains, UndoExposures) {
  Grid<double> sums(3, 3, 0), counts(3, 3, 0);
  const double logs[] = {0.1, -0.2, 0.1};
  for (int i = 0; i < 3; ++i)
    for (int j = i + 1; j < 3; ++j) {
      counts(i, j) = 50;
      sums(i, j) = 50 * (logs[i] - logs[j]);
    }
  const std::vector<double> gains = balance_gains(sums, counts);
  EXPECT_NEAR(gains[0] / gains[1], std::exp(-0.3), 1e-3);
  EXPECT_NEAR(gains[0] / gains[2], 1, 1e-3);
}

}  // namespace
}  // namespace waymark::test
