// SPDX-License-Identifier: Apache-2.0
#include "geo/spatial_index.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace waymark::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Points = std::vector<Eigen::Vector3d>;

std::vector<std::size_t> such_that(const Points& points, auto&& holds) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (holds(points[i])) found.push_back(i);
  return found;
}

std::vector<std::size_t> nearest_by_sorting(const Points& points, const Eigen::Vector3d& centre,
                                            std::size_t count) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return (points[i] - centre).squaredNorm(); });
  order.resize(std::min(count, order.size()));
  return order;
}

// Even seeds: whole numbers only, so that ties and coincident points are frequent.
Points random_points(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0, 10);
  Points points(count);
  for (Eigen::Vector3d& point : points) {
    point = {place(random), place(random), seed % 3 == 0 ? 0.0 : place(random)};
    if (seed % 2 == 0) point = point.array().floor();
  }
  return points;
}

TEST(SpatialIndex, AgreesWithTestingEveryPoint) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Points points = random_points(seed, 1 + seed * 7);
    const SpatialIndex index(points);
    for (const Eigen::Vector3d& centre : random_points(seed + 1000 - seed % 2, 12)) {
      const double radius = 0.5 + seed % 5;
      const Eigen::AlignedBox3d box(centre.array() - radius, centre.array() + radius);
      ASSERT_EQ(index.in_box(box), such_that(points, [&](const auto& p) { return box.contains(p); })) << seed;
      ASSERT_EQ(
          index.within(centre, radius),
          such_that(points, [&](const auto& p) { return (p - centre).squaredNorm() <= radius * radius; }))
          << seed;
      for (const std::size_t count : {1, 3, 50})
        ASSERT_EQ(index.nearest(centre, count), nearest_by_sorting(points, centre, count)) << seed;
    }
  }
}

TEST(SpatialIndex, IncludesBorders) {
  const Points points = {{0, 0, 0}, {3, 4, 0}, {6, 0, 0}};
  const SpatialIndex index(points);
  EXPECT_THAT(index.within({0, 0, 0}, 5), ElementsAre(0, 1));
  EXPECT_THAT(index.in_box({Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(6, 4, 0)}), ElementsAre(1, 2));
}

TEST(SpatialIndex, IsEmptyWithoutPoints) {
  const SpatialIndex index(Points{});
  EXPECT_EQ(index.size(), 0u);
  EXPECT_THAT(index.nearest({0, 0, 0}, 3), IsEmpty());
  EXPECT_THAT(index.within({0, 0, 0}, 3), IsEmpty());
}

TEST(SpatialIndex, InvalidQueriesFindNothing) {
  const SpatialIndex index(Points{{0, 0, 0}});
  EXPECT_THAT(index.within({0, 0, 0}, -1), IsEmpty());
  EXPECT_THAT(index.in_box({}), IsEmpty());
  EXPECT_THAT(index.nearest({0, 0, 0}, 0), IsEmpty());
}

}  // namespace
}  // namespace waymark::test
