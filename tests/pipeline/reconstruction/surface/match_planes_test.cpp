// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/match_planes.hpp"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "tests/pipeline/reconstruction/made_views.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr double kWidestAngle = 25 * std::numbers::pi / 180;

// Nodes of 0.43 m about the middle of a site that five views see; `lift` above the terrain.
NodeSurface surface_of(const testbed::Scene& scene, double lift) {
  NodeSurface out{.grid = {.west = -8.6, .north = 8.6, .cell = 0.43, .columns = 40, .rows = 40},
                  .window = {0, 0, 40, 40},
                  .heights = {}};
  for (std::int64_t r = 0; r < 40; ++r)
    for (std::int64_t c = 0; c < 40; ++c)
      out.heights.push_back(static_cast<float>(
          scene.terrain.height(out.grid.x(static_cast<double>(c)), out.grid.y(static_cast<double>(r)))
              .value() +
          lift));
  return out;
}

class MatchPlanes : public ::testing::Test {
 protected:
  MatchPlanes()
      : scene_(made_site(5)),
        views_(made_flight(scene_)),
        images_(views_, std::size_t{1} << 30),
        used_(views_.size()) {
    std::iota(used_.begin(), used_.end(), std::size_t{0});
  }
  ComparedViews compared() { return {views_, images_, used_, kWidestAngle}; }

  // The definition for one cell, in double precision: one unknown per node of the window beside the plane.
  PlaneMatch by_definition(const NodeSurface& surface, std::int64_t c, std::int64_t r,
                           const PlaneRules& rules) {
    const double node = surface.grid.cell, step = 0.5 * node / std::tan(kWidestAngle);
    std::vector<double> taper;
    std::vector<Eigen::Vector3d> row;
    std::vector<std::vector<double>> value(views_.size());
    std::vector<std::vector<Eigen::Vector3d>> slope(views_.size());
    for (std::int64_t j = r - 3; j <= r + 4; ++j)
      for (std::int64_t i = c - 3; i <= c + 4; ++i) {
        const double x = double(i - c) - 0.5, y = double(j - r) - 0.5;
        taper.push_back(std::exp(-0.5 * (x * x + y * y) / (rules.width * rules.width)));
        row.emplace_back(1, x * node, y * node);
        for (std::size_t v = 0; v < views_.size(); ++v) {
          const auto at = [&](double lift) {
            const Eigen::Vector3d p(surface.grid.x(double(i)), surface.grid.y(double(j)),
                                    double(surface.at(i, j)) + lift);
            const Eigen::Vector2d q = project(views_[v].view, {p}).value();
            return double(
                bilinear(images_.get(v, 0)->pixels, static_cast<float>(q.x()), static_cast<float>(q.y())));
          };
          value[v].push_back(at(0));
          slope[v].push_back((at(step) - at(-step)) / (2 * step) * row.back());
        }
      }
    const std::size_t nodes = taper.size();
    const double total = std::accumulate(taper.begin(), taper.end(), 0.0);
    // Offsets and gains leave the brightness normalized and its derivatives at right angles to it.
    for (std::size_t v = 0; v < views_.size(); ++v) {
      double mean = 0, square = 0;
      Eigen::Vector3d middle = Eigen::Vector3d::Zero(), along = middle;
      for (std::size_t n = 0; n < nodes; ++n)
        mean += taper[n] / total * value[v][n], middle += taper[n] / total * slope[v][n];
      for (std::size_t n = 0; n < nodes; ++n) square += taper[n] / total * std::pow(value[v][n] - mean, 2);
      for (std::size_t n = 0; n < nodes; ++n) {
        value[v][n] = (value[v][n] - mean) / std::sqrt(square);
        slope[v][n] = (slope[v][n] - middle) / std::sqrt(square);
        along += taper[n] / total * value[v][n] * slope[v][n];
      }
      for (std::size_t n = 0; n < nodes; ++n) slope[v][n] -= value[v][n] * along;
    }
    std::vector<double> weight(views_.size(), 1);
    Eigen::VectorXd x;
    double variance = 0;
    for (int round = 0; round < 3; ++round) {
      const auto unknowns = static_cast<Eigen::Index>(3 + nodes);
      Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
      Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
      for (std::size_t v = 0; v < views_.size(); ++v)
        for (std::size_t n = 0; n < nodes; ++n) {
          Eigen::VectorXd line = Eigen::VectorXd::Zero(unknowns);
          line.head<3>() = slope[v][n];
          line(static_cast<Eigen::Index>(3 + n)) = -1;  // of the mean of the views
          normal += weight[v] * taper[n] * line * line.transpose();
          right -= weight[v] * taper[n] * value[v][n] * line;
        }
      for (int k = 1; k < 3; ++k)
        normal(k, k) += (round == 0 ? 0.1 : 1.0) / (rules.slope_sd * rules.slope_sd);
      const Eigen::MatrixXd inverse = normal.inverse();
      x = inverse * right;
      variance = inverse(0, 0);
      const double all = std::accumulate(weight.begin(), weight.end(), 0.0);
      for (std::size_t v = 0; v < views_.size(); ++v) {
        double sum = 0;
        for (std::size_t n = 0; n < nodes; ++n)
          sum +=
              taper[n] *
              std::pow(value[v][n] + slope[v][n].dot(x.head<3>()) - x(static_cast<Eigen::Index>(3 + n)), 2);
        weight[v] = 1 / (sum / (total * (1 - weight[v] / all)) + 0.02);
      }
    }
    return {static_cast<float>(x(0)), static_cast<float>(std::sqrt(variance))};
  }

  const testbed::Scene scene_;
  const std::vector<SurfaceView> views_;
  ImageLevels images_;
  std::vector<std::size_t> used_;
};

TEST_F(MatchPlanes, MatchesTheDefinition) {
  const NodeSurface surface = surface_of(scene_, 0.2);
  const std::vector<PlaneMatch> found = match_planes(compared(), surface, {8, 8, 16, 16}, {});
  for (const std::int64_t c : {8, 14, 22})
    for (const std::int64_t r : {8, 16}) {
      const PlaneMatch slow = by_definition(surface, c, r, {});
      const PlaneMatch& fast = found[static_cast<std::size_t>((r - 8) / 2 * 8 + (c - 8) / 2)];
      EXPECT_NEAR(fast.shift, slow.shift, 2e-3) << c << " " << r;
      EXPECT_NEAR(fast.sd, slow.sd, 1e-3) << c << " " << r;
    }
}

TEST_F(MatchPlanes, FindTheTerrainBelowALiftedSurface) {
  for (const PlaneMatch& match : match_planes(compared(), surface_of(scene_, 0.3), {4, 4, 32, 32}, {})) {
    EXPECT_NEAR(match.shift, -0.3, 0.35);  // 0.2 pixels of parallax are 0.2 m
    EXPECT_LT(match.sd, 0.3);
  }
}

TEST_F(MatchPlanes, CellsWithHalfAWindowOfSurfaceAreMatchedThoseWithLessAreNot) {
  NodeSurface surface = surface_of(scene_, 0);
  for (std::size_t n = 0; n < surface.heights.size(); ++n)
    if (n % 40 >= 20) surface.heights[n] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<PlaneMatch> found = match_planes(compared(), surface, {4, 4, 32, 32}, {});
  for (std::size_t row = 0; row < 16; ++row) {
    EXPECT_FALSE(std::isnan(found[row * 16 + 7].shift));  // nodes 18 and 19
    EXPECT_TRUE(std::isnan(found[row * 16 + 8].shift));
  }
}

TEST_F(MatchPlanes, FlatImagesHaveNoMatch) {
  std::vector<SurfaceView> flat;
  for (const SurfaceView& view : views_) flat.push_back(made_view(view.name, view.view, Pixels(160, 160, 9)));
  ImageLevels images(flat, std::size_t{1} << 30);
  for (const PlaneMatch& match :
       match_planes({flat, images, used_, kWidestAngle}, surface_of(scene_, 0), {8, 8, 16, 16}, {}))
    EXPECT_TRUE(std::isnan(match.shift));
}

}  // namespace
}  // namespace waymark::test
