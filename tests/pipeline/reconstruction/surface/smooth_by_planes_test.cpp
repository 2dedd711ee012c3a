// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/smooth_by_planes.hpp"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "core/random.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr float kGap = std::numeric_limits<float>::quiet_NaN();

Grid<float> tilted(std::int64_t columns, std::int64_t rows) {
  Grid<float> out(columns, rows);
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t c = 0; c < columns; ++c)
      out(c, r) = 2 + 0.3f * static_cast<float>(c) - 0.2f * static_cast<float>(r);
  return out;
}

Grid<float> noisy(Grid<float> heights, float sd, std::uint64_t seed) {
  Random random(seed);
  for (float& h : heights.cells()) h += sd * static_cast<float>(random.normal());
  return heights;
}

TEST(SmoothByPlanes, PlanesStayPlanesAtBordersAndGapsToo) {
  Grid<float> plane = tilted(14, 12);
  plane(5, 5) = plane(6, 5) = plane(0, 3) = kGap;
  const Grid<float> smooth = smooth_by_planes(plane, Grid<float>(14, 12, 0.5f));
  for (std::int64_t r = 0; r < 12; ++r)
    for (std::int64_t c = 0; c < 14; ++c) {
      if (std::isnan(plane(c, r))) {
        EXPECT_TRUE(std::isnan(smooth(c, r)));
      } else {
        EXPECT_NEAR(smooth(c, r), plane(c, r), 0.02)
            << c << " " << r;  // slopes at the border are held weakly
      }
    }
}

TEST(SmoothByPlanes, JumpsStay) {
  Grid<float> step(16, 12, 0);
  for (std::int64_t r = 0; r < 12; ++r)
    for (std::int64_t c = 8; c < 16; ++c) step(c, r) = 3;  // 15 standard deviations
  const Grid<float> smooth = smooth_by_planes(noisy(step, 0.2f, 3), Grid<float>(16, 12, 0.2f));
  for (std::int64_t r = 0; r < 12; ++r)
    for (std::int64_t c = 0; c < 16; ++c) EXPECT_NEAR(smooth(c, r), step(c, r), 0.8);
}

// A boulder of 3 x 3 cells, 10 standard deviations high, keeps its top.
TEST(SmoothByPlanes, BouldersKeepTheirTops) {
  Grid<float> boulder(15, 15, 0);
  for (std::int64_t r = 6; r < 9; ++r)
    for (std::int64_t c = 6; c < 9; ++c) boulder(c, r) = 2;
  EXPECT_GT(smooth_by_planes(boulder, Grid<float>(15, 15, 0.2f))(7, 7), 1.9f);
}

TEST(SmoothByPlanes, HalvesIndependentErrors) {
  const Grid<float> plane = tilted(60, 60);
  const Grid<float> smooth = smooth_by_planes(noisy(plane, 0.2f, 5), Grid<float>(60, 60, 0.2f));
  double squares = 0;
  for (std::size_t i = 0; i < smooth.cells().size(); ++i)
    squares += std::pow(static_cast<double>(smooth.cells()[i] - plane.cells()[i]), 2);
  EXPECT_LT(std::sqrt(squares / 3600), 0.1);
}

TEST(SmoothByPlanes, CellsBeyondTheHaloHaveNoEffect) {
  const Grid<float> a = noisy(tilted(30, 9), 0.2f, 7);
  Grid<float> b = a;
  for (std::int64_t r = 0; r < 9; ++r)
    for (std::int64_t c = 10 + kSmoothingHalo; c < 30; ++c) b(c, r) = r % 2 == 0 ? 5.0f : kGap;
  const Grid<float> sd(30, 9, 0.2f);
  const Grid<float> p = smooth_by_planes(a, sd), q = smooth_by_planes(b, sd);
  for (std::int64_t r = 0; r < 9; ++r)
    for (std::int64_t c = 0; c < 10; ++c) EXPECT_EQ(p(c, r), q(c, r));
}

// The definition, cell by cell, with the planes of all rounds in plain lists.
Grid<float> smooth_by_definition(const Grid<float>& heights, const Grid<float>& sd,
                                 const PlaneSmoothing& rules) {
  const std::int64_t columns = heights.columns(), rows = heights.rows();
  Grid<Eigen::Vector3d> plane(columns, rows, Eigen::Vector3d::Zero());
  Grid<double> variance(columns, rows, 0);
  for (const double reach : {3.0, rules.reach[0], rules.reach[1]}) {
    const bool first = reach == 3.0;
    Grid<Eigen::Vector3d> next = plane;
    Grid<double> next_variance = variance;
    for (std::int64_t r = 0; r < rows; ++r)
      for (std::int64_t c = 0; c < columns; ++c) {
        if (std::isnan(heights(c, r))) continue;
        std::vector<Eigen::Vector4d> lines;  // row of the design and height, times the root of the weight
        double weights = 0;
        for (std::int64_t j = 0; j < rows; ++j)
          for (std::int64_t i = 0; i < columns; ++i) {
            const Eigen::Vector3d row(1, double(i - c), double(j - r));
            const double distance = row.tail<2>().norm();
            if (std::isnan(heights(i, j)) || distance > reach + 1e-9) continue;
            double w = (1 - std::pow(distance / (reach + 1), 2)) / std::pow(double(sd(i, j)), 2);
            const double d = plane(i, j).x() - row.dot(plane(c, r));
            if (!first && distance > 0)
              w *= std::max(0.0, 1 - d * d / (rules.separation * (variance(c, r) + variance(i, j))));
            weights += w;
            lines.emplace_back(std::sqrt(w) * Eigen::Vector4d(1, row.y(), row.z(), double(heights(i, j))));
          }
        const double hold = std::sqrt(0.5) / double(sd(c, r));
        lines.emplace_back(0, hold, 0, hold * plane(c, r).y());
        lines.emplace_back(0, 0, hold, hold * plane(c, r).z());
        Eigen::MatrixXd design(lines.size(), 3);
        Eigen::VectorXd right(lines.size());
        for (std::size_t n = 0; n < lines.size(); ++n) {
          design.row(Eigen::Index(n)) = lines[n].head<3>().transpose();
          right(Eigen::Index(n)) = lines[n](3);
        }
        next(c, r) = design.colPivHouseholderQr().solve(right);
        next_variance(c, r) = std::min(std::pow(double(sd(c, r)), 2), rules.shared / weights);
        if (first) {
          next(c, r).x() = double(heights(c, r));
          next_variance(c, r) = std::pow(double(sd(c, r)), 2);
        }
      }
    plane = next;
    variance = next_variance;
  }
  Grid<float> out = heights;
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t c = 0; c < columns; ++c)
      if (!std::isnan(heights(c, r))) out(c, r) = static_cast<float>(plane(c, r).x());
  return out;
}

TEST(SmoothByPlanes, MatchesTheDefinition) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Random random(seed);
    Grid<float> heights = noisy(tilted(11, 10), 0.3f, seed), sd(11, 10);
    for (std::int64_t r = 3; r < 7; ++r)
      for (std::int64_t c = 4; c < 8; ++c) heights(c, r) += 1.5f;
    for (float& s : sd.cells()) s = static_cast<float>(0.2 + 0.3 * random.uniform());
    for (float& h : heights.cells())
      if (random.uniform() < 0.15) h = kGap;
    const Grid<float> a = smooth_by_planes(heights, sd), b = smooth_by_definition(heights, sd, {});
    for (std::size_t i = 0; i < a.cells().size(); ++i) {
      ASSERT_EQ(std::isnan(a.cells()[i]), std::isnan(b.cells()[i]));
      if (!std::isnan(a.cells()[i])) {
        ASSERT_NEAR(a.cells()[i], b.cells()[i], 1e-4) << "seed " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace waymark::test
