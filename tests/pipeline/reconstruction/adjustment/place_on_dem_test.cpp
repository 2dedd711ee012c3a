// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/place_on_dem.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "core/random.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;
using ::testing::HasSubstr;

using HeightFunction = std::function<double(double, double)>;

// Hills of random place, width and height: no part of it occurs twice.
HeightFunction hills(std::uint64_t seed, double side) {
  struct Hill {
    double x, y, width, height;
  };
  std::vector<Hill> all;
  Random random(seed, "hills");
  for (int i = 0; i < 60; ++i) {
    const double x = random.uniform(0, side), y = random.uniform(0, side);
    const double width = random.uniform(0.02, 0.08) * side, height = random.uniform(-30, 30);
    all.push_back({x, y, width, height});
  }
  return [all](double x, double y) {
    double sum = 0;
    for (const Hill& h : all)
      sum += h.height * std::exp(-(std::pow(x - h.x, 2) + std::pow(y - h.y, 2)) / (2 * h.width * h.width));
    return sum;
  };
}

CoarseHeights dem_of(const HeightFunction& height, double cell, std::int64_t size) {
  CoarseHeights dem{
      .grid = {.west = 0, .north = cell * double(size), .cell = cell, .columns = size, .rows = size},
      .heights = Grid<float>(size, size)};
  for (std::int64_t r = 0; r < size; ++r)
    for (std::int64_t c = 0; c < size; ++c)
      dem.heights(c, r) = static_cast<float>(height(dem.grid.x(double(c)), dem.grid.y(double(r))));
  return dem;
}

/// Points and cameras over a part of the terrain, in a frame of their own.
struct FreeScene {
  std::vector<Eigen::Vector3d> points = {}, centres = {};
  Similarity map_from_frame = {};
};

FreeScene scene_of(const HeightFunction& height, std::uint64_t seed, double side, double sd) {
  Random random(seed, "relief");
  FreeScene scene;
  scene.map_from_frame = {.scale = 37};
  scene.map_from_frame.rotation = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized().toRotationMatrix();
  scene.map_from_frame.shift = {310, 95, -40};
  const auto into_frame = [&](const Eigen::Vector3d& at) -> Eigen::Vector3d {
    const Similarity& s = scene.map_from_frame;
    return s.rotation.transpose() * (at - s.shift) / s.scale;
  };
  for (int i = 0; i < 1500; ++i) {
    const double x = 300 + random.uniform(0, side), y = 400 + random.uniform(0, side);
    const double error = random.normal(0, sd), gross = i % 50 == 0 ? 60 : 0;  // 2 % of the points are wrong
    scene.points.push_back(into_frame({x, y, height(x, y) + error + gross}));
  }
  for (int i = 0; i < 5; ++i) scene.centres.push_back(into_frame({300 + i * side / 5, 400 + side / 2, 400}));
  return scene;
}

DemPlacementResult placed(const FreeScene& scene, const CoarseHeights& dem) {
  return place_on_dem({.points = scene.points, .centres = scene.centres}, dem);
}

TEST(PlaceOnDem, FindsShiftRotationAndScale) {
  for (const std::uint64_t seed : {1, 2}) {
    const HeightFunction height = hills(seed, 1200);
    const FreeScene scene = scene_of(height, seed, 300, 0.5);
    const DemPlacementResult result = placed(scene, dem_of(height, 6, 200));
    ASSERT_TRUE(result.found) << "seed " << seed << ": " << result.message;
    const Similarity &found = result.found->map_from_frame, &truth = scene.map_from_frame;
    double largest = 0;
    for (const Eigen::Vector3d& p : scene.points) largest = std::max(largest, (found * p - truth * p).norm());
    EXPECT_LT(largest, 6) << "seed " << seed;  // a cell of the DEM
    EXPECT_LT(std::abs(std::log(found.scale / truth.scale)),
              5 * std::sqrt(result.found->covariance(6, 6)) + 0.005)
        << "seed " << seed;
    EXPECT_LT(result.found->residual, 1.5) << "seed " << seed;
  }
}

TEST(PlaceOnDem, FlatTerrainIsRefused) {
  const HeightFunction flat = [](double, double) { return 12.0; };
  const DemPlacementResult result = placed(scene_of(flat, 1, 300, 0.5), dem_of(flat, 6, 200));
  EXPECT_FALSE(result.found);
  EXPECT_THAT(result.message, HasSubstr("in the DEM"));
  const HeightFunction plane = [](double x, double y) { return 0.1 * x + 0.2 * y; };
  EXPECT_FALSE(placed(scene_of(plane, 1, 300, 0.5), dem_of(plane, 6, 200)).found);
}

TEST(PlaceOnDem, RepeatedTerrainIsAmbiguous) {
  const HeightFunction waves = [](double x, double y) {
    return 20 * std::sin(x / 30) * std::cos(y / 40) + 10 * std::sin(y / 25);
  };
  const DemPlacementResult result = placed(scene_of(waves, 1, 300, 0.5), dem_of(waves, 6, 200));
  EXPECT_FALSE(result.found);
  EXPECT_THAT(result.message, HasSubstr("ambiguous"));
}

TEST(PlaceOnDem, OtherTerrainIsRefused) {
  for (const std::uint64_t seed : {9, 10}) {
    const DemPlacementResult result =
        placed(scene_of(hills(1, 1200), 1, 300, 0.5), dem_of(hills(seed, 1200), 6, 200));
    EXPECT_FALSE(result.found) << "seed " << seed << ": " << result.found->residual << " of "
                               << result.found->relief;
  }
}

TEST(PlaceOnDem, FewPointsAreRefused) {
  FreeScene scene = scene_of(hills(1, 1200), 1, 300, 0.5);
  scene.points.resize(20);
  const DemPlacementResult result = placed(scene, dem_of(hills(1, 1200), 6, 200));
  EXPECT_FALSE(result.found);
  EXPECT_THAT(result.message, HasSubstr("20 tie points are too few"));
}

}  // namespace
}  // namespace waymark::test
