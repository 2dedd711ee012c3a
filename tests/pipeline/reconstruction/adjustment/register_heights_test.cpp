// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/register_heights.hpp"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <vector>

#include "core/random.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;
using ::testing::HasSubstr;

using HeightFunction = std::function<double(double, double)>;

// Hills of random place, width and height on 3 km: no part of it occurs twice.
HeightFunction hills(std::uint64_t seed) {
  struct Hill {
    double x, y, width, height;
  };
  std::vector<Hill> all;
  Random random(seed, "register heights");
  for (int i = 0; i < 150; ++i) {
    const double x = random.uniform(0, 3000), y = random.uniform(0, 3000);
    const double width = random.uniform(30, 200), height = random.uniform(-0.25, 0.25) * width;
    all.push_back({x, y, width, height});
  }
  return [all](double x, double y) {
    double sum = 0;
    for (const Hill& h : all)
      sum += h.height * std::exp(-(std::pow(x - h.x, 2) + std::pow(y - h.y, 2)) / (2 * h.width * h.width));
    return sum;
  };
}

CoarseHeights coarse_dem_of(const HeightFunction& height, double cell, std::int64_t size, double west = 0,
                            double south = 0) {
  CoarseHeights dem{.grid = {.west = west,
                             .north = south + cell * double(size),
                             .cell = cell,
                             .columns = size,
                             .rows = size},
                    .heights = Grid<float>(size, size)};
  for (std::int64_t r = 0; r < size; ++r)
    for (std::int64_t c = 0; c < size; ++c)
      dem.heights(c, r) = static_cast<float>(height(dem.grid.x(double(c)), dem.grid.y(double(r))));
  return dem;
}

constexpr std::int64_t kCells = 160;  // of a map

// White noise smoothed by a Gaussian of `sigma` cells, of unit variance.
Grid<float> smooth_noise(Random& random, double sigma) {
  const int reach = int(std::ceil(3 * sigma));
  const std::int64_t wide = kCells + 2 * reach;
  Grid<float> white(wide, wide), rows(kCells, wide), out(kCells, kCells);
  for (std::int64_t r = 0; r < wide; ++r)
    for (std::int64_t c = 0; c < wide; ++c) white(c, r) = float(random.normal());
  std::vector<double> kernel;
  double squares = 0;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(std::exp(-k * k / (2 * sigma * sigma)));
    squares += kernel.back() * kernel.back();
  }
  const auto sum = [&](const Grid<float>& from, std::int64_t c, std::int64_t r, int dx, int dy) {
    double total = 0;
    for (int k = 0; k <= 2 * reach; ++k)
      total += kernel[std::size_t(k)] * double(from(c + k * dx, r + k * dy));
    return float(total / std::sqrt(squares));
  };
  for (std::int64_t r = 0; r < wide; ++r)
    for (std::int64_t c = 0; c < kCells; ++c) rows(c, r) = sum(white, c, r, 1, 0);
  for (std::int64_t r = 0; r < kCells; ++r)
    for (std::int64_t c = 0; c < kCells; ++c) out(c, r) = sum(rows, c, r, 0, 1);
  return out;
}

/// A map in a frame of its own, whose errors neighbours share over `length` metres.
struct RoughMap {
  CoarseHeights dem = {};
  LevelSimilarity truth = {};
};

RoughMap rough_map(const HeightFunction& height, std::uint64_t seed, double error, double length) {
  Random random(seed, "rough map");
  RoughMap out;
  out.truth = {.log_scale = random.uniform(-0.4, 0.4),
               .yaw = random.uniform(-3, 3),
               .shift = {random.uniform(1200, 1800), random.uniform(1200, 1800)},
               .lift = random.uniform(-500, 500)};
  const double scale = std::exp(out.truth.log_scale);
  const HeightFunction seen = [&](double x, double y) {
    const Eigen::Vector3d at = out.truth * Eigen::Vector3d(x, y, 0);
    return (height(at.x(), at.y()) - out.truth.lift) / scale;
  };
  const double side = 800 / scale;
  out.dem = coarse_dem_of(seen, side / kCells, kCells, -side / 2, -side / 2);
  const Grid<float> noise = smooth_noise(random, length / scale / out.dem.grid.cell);
  for (std::int64_t r = 0; r < kCells; ++r)
    for (std::int64_t c = 0; c < kCells; ++c) out.dem.heights(c, r) += float(error / scale) * noise(c, r);
  return out;
}

struct PlacementErrors {
  double squares = 0, largest = 0;  // over the covariance; of the corners, metres
};

PlacementErrors errors_of(const HeightRegistration& found, const RoughMap& map) {
  const LevelSimilarity& s = found.reference_from_map;
  const double turn = std::remainder(s.yaw - map.truth.yaw, 2 * 3.14159265358979323846);
  // the middle of the cells is that of the grid
  const double half = map.dem.grid.cell * double(map.dem.grid.columns) / 2;
  double mean = 0;
  for (const float h : map.dem.heights.cells()) mean += double(h) / double(map.dem.heights.cells().size());
  const Eigen::Vector3d middle(map.dem.grid.west + half, map.dem.grid.north - half, mean);
  const Eigen::Vector3d off = s * middle - map.truth * middle;
  Eigen::Matrix<double, 5, 1> error;
  error << off.x(), off.y(), turn, s.log_scale - map.truth.log_scale, off.z();
  PlacementErrors out{.squares = error.dot(found.covariance.ldlt().solve(error))};
  for (const double sx : {-1, 1})
    for (const double sy : {-1, 1}) {
      const Eigen::Vector3d corner = middle + half * Eigen::Vector3d(sx, sy, 0);
      out.largest = std::max(out.largest, (s * corner - map.truth * corner).norm());
    }
  return out;
}

TEST(RegisterHeights, FindsThePlaceWithItsAccuracy) {
  for (const double length : {5.0, 20.0}) {
    double squares = 0;
    int count = 0;
    for (std::uint64_t seed = 17; seed <= 26; ++seed) {
      const HeightFunction height = hills(seed);
      const RoughMap map = rough_map(height, seed, 1, length);
      const HeightRegistrationResult result = register_heights(map.dem, coarse_dem_of(height, 10, 300));
      ASSERT_TRUE(result.found) << "seed " << seed << ": " << result.message;
      const PlacementErrors errors = errors_of(*result.found, map);
      EXPECT_LT(errors.largest, 10) << "a cell of the reference, seed " << seed;
      EXPECT_LT(errors.squares, 40) << "seed " << seed;
      squares += errors.squares;
      count += 5;
    }
    EXPECT_GT(squares / count, 0.5) << "errors shared over " << length << " m";
    EXPECT_LT(squares / count, 1.8) << "errors shared over " << length << " m";
  }
}

TEST(RegisterHeights, OtherTerrainIsRefused) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const RoughMap map = rough_map(hills(seed), seed, 1, 40);
    const HeightRegistrationResult result =
        register_heights(map.dem, coarse_dem_of(hills(seed + 100), 10, 300));
    EXPECT_FALSE(result.found) << "seed " << seed;
  }
}

TEST(RegisterHeights, FlatTerrainIsRefused) {
  const HeightFunction flat = [](double, double) { return 12.0; };
  EXPECT_FALSE(register_heights(rough_map(flat, 1, 1, 40).dem, coarse_dem_of(flat, 10, 300)).found);
}

TEST(RegisterHeights, AReferenceWithLargeCellsIsRefused) {
  const HeightFunction height = hills(1);
  const HeightRegistrationResult result =
      register_heights(rough_map(height, 1, 1, 40).dem, coarse_dem_of(height, 300, 10));
  EXPECT_FALSE(result.found);
  EXPECT_THAT(result.message, HasSubstr("10 cells of the reference are 3e+03 m"));
}

TEST(RegisterHeights, UnknownCellsAreLeftOut) {
  const HeightFunction height = hills(3);
  RoughMap map = rough_map(height, 3, 0.5, 5);
  for (std::int64_t r = 0; r < kCells; ++r)
    for (std::int64_t c = 0; c < kCells; ++c)
      if (std::hypot(double(c) - 100, double(r) - 60) < 30)
        map.dem.heights(c, r) = std::numeric_limits<float>::quiet_NaN();
  const HeightRegistrationResult result = register_heights(map.dem, coarse_dem_of(height, 10, 300));
  ASSERT_TRUE(result.found) << result.message;
  EXPECT_LT(errors_of(*result.found, map).largest, 10);
}

TEST(RegisterHeights, AMapWithoutHeightsIsRefused) {
  RoughMap map = rough_map(hills(1), 1, 1, 40);
  for (std::int64_t r = 0; r < kCells; ++r)
    for (std::int64_t c = 0; c < kCells; ++c) map.dem.heights(c, r) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(register_heights(map.dem, coarse_dem_of(hills(1), 10, 300)).message, "the map has no heights");
}

}  // namespace
}  // namespace waymark::test
