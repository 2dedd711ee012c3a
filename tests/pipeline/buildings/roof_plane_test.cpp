// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/roof_plane.hpp"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <vector>

#include "core/random.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

struct Cell {
  Eigen::Vector2d centre;
  std::vector<Eigen::Vector3d> points;
  CellSums sums;
};

/// Cells of half a metre with points of millimetres near a plane 1500 m above the datum.
std::vector<Cell> cells_on_plane(Random& random, double slope_x, double slope_y, double noise) {
  std::vector<Cell> cells;
  for (int i = 0; i < 9; ++i) {
    Cell cell{.centre = {100 + 0.5 * (i % 3), -40 + 0.5 * (i / 3)}, .points = {}, .sums = {}};
    for (int k = 0; k < 3; ++k) {
      const double dx = std::round(random.uniform(-250, 250)), dy = std::round(random.uniform(-250, 250));
      const double x = cell.centre.x() + dx / 1000, y = cell.centre.y() + dy / 1000;
      const double z =
          std::round(1000 * (1500 + slope_x * (x - 100) + slope_y * (y + 40) + noise * random.normal()));
      cell.points.emplace_back(x, y, z / 1000);
      const auto a = std::llround(dx), b = std::llround(dy), c = std::llround(z);
      CellSums& s = cell.sums;
      ++s.count, s.x += int(a), s.y += int(b), s.z += c;
      s.xx += a * a, s.xy += a * b, s.yy += b * b, s.xz += a * c, s.yz += b * c, s.zz += c * c;
    }
    cells.push_back(std::move(cell));
  }
  return cells;
}

TEST(PlaneSums, FitsAsLeastSquaresOfThePoints) {
  Random random(7, "planes");
  for (int trial = 0; trial < 200; ++trial) {
    const auto cells = cells_on_plane(random, random.uniform(-2, 2), random.uniform(-2, 2), 0.1);
    PlaneSums sums({99, -41}, 1499);
    std::vector<Eigen::Vector3d> points;
    for (const Cell& cell : cells) {
      sums.add(cell.sums, cell.centre);
      points.insert(points.end(), cell.points.begin(), cell.points.end());
    }
    const auto plane = sums.fit();
    ASSERT_TRUE(plane);
    Eigen::MatrixXd a(points.size(), 3);
    Eigen::VectorXd z(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      a.row(static_cast<Eigen::Index>(i)) << 1, points[i].x() - 100, points[i].y() + 40;
      z[static_cast<Eigen::Index>(i)] = points[i].z() - 1500;
    }
    const Eigen::Vector3d truth = a.colPivHouseholderQr().solve(z);
    EXPECT_NEAR(plane->slope_x, truth[1], 1e-5);
    EXPECT_NEAR(plane->slope_y, truth[2], 1e-5);
    EXPECT_NEAR(plane->z(100, -40), 1500 + truth[0], 1e-5);
    const double rms = std::sqrt((a * truth - z).squaredNorm() / double(points.size() - 3)) * plane->cosine();
    EXPECT_NEAR(plane->rms, rms, 1e-5);
    for (const Cell& cell : cells) {
      double sum = 0;
      for (const Eigen::Vector3d& p : cell.points)
        sum += std::pow(plane->distance(p.x(), p.y(), p.z()), 2) / double(cell.points.size());
      EXPECT_NEAR(rms_distance(cell.sums, cell.centre, *plane), std::sqrt(sum), 1e-5);
    }
  }
}

TEST(PlaneSums, FewReturnsOrReturnsOnALineGiveNoPlane) {
  PlaneSums few({0, 0}, 0), line({0, 0}, 0);
  for (int i = 0; i < 9; ++i) {
    const int x = 250 * (i % 3) - 250;
    const CellSums on_line{.count = 1, .x = x, .xx = std::int64_t{x} * x};
    if (i < 5) few.add({.count = 1}, {0.5 * i, 0.7 * (i % 2)});
    line.add(on_line, {0, 0});
  }
  EXPECT_FALSE(few.fit());
  EXPECT_FALSE(line.fit());
}

}  // namespace
}  // namespace waymark::test
