// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/height_checks.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/solve.hpp"

namespace waymark::pipeline {
namespace {

struct Neighbour {
  double x, y, h;
};

// Height and slopes at the middle, with Huber weights; `scale` becomes the robust spread of the residuals.
Eigen::Vector3d robust_plane(const std::vector<Neighbour>& cells, double min_scale, double& scale) {
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  std::vector<double> weight(cells.size(), 1), residual(cells.size());
  for (int round = 0; round < 4; ++round) {
    Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Eigen::Vector3d row(1, cells[i].x, cells[i].y);
      normal += weight[i] * row * row.transpose();
      right += weight[i] * cells[i].h * row;
    }
    plane = solve_symmetric(normal, right);
    for (std::size_t i = 0; i < cells.size(); ++i)
      residual[i] = std::abs(cells[i].h - plane.x() - plane.y() * cells[i].x - plane.z() * cells[i].y);
    std::vector<double> sorted = residual;
    std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
    scale = std::max(min_scale, 1.4826 * sorted[sorted.size() / 2]);
    for (std::size_t i = 0; i < cells.size(); ++i)
      weight[i] = residual[i] <= 1.5 * scale ? 1 : 1.5 * scale / residual[i];
  }
  return plane;
}

}  // namespace

Grid<std::uint8_t> cells_off_plane(const Grid<float>& heights, const Grid<float>& sd, double limit) {
  constexpr std::int64_t kReach = 3;
  Grid<std::uint8_t> off(heights.columns(), heights.rows(), 0);
  tbb::parallel_for(std::int64_t{0}, heights.rows(), [&](std::int64_t r) {
    std::vector<Neighbour> near;
    for (std::int64_t c = 0; c < heights.columns(); ++c) {
      const double own = static_cast<double>(heights(c, r)), own_sd = static_cast<double>(sd(c, r));
      if (std::isnan(own)) continue;
      near.clear();
      for (std::int64_t j = -kReach; j <= kReach; ++j)
        for (std::int64_t i = -kReach; i <= kReach; ++i)
          if ((i != 0 || j != 0) && heights.contains(c + i, r + j) && !std::isnan(heights(c + i, r + j)))
            near.push_back({double(i), double(j), static_cast<double>(heights(c + i, r + j)) - own});
      if (near.size() < 8) continue;
      double scale = 0;
      const Eigen::Vector3d plane = robust_plane(near, own_sd, scale);
      if (std::abs(plane.x()) <= limit * scale) continue;
      // Smooth on its own side: neighbours agree after the slope of the plane is taken off.
      int agree = 0;
      for (const Neighbour& n : near)
        if (std::abs(n.x) <= 1 && std::abs(n.y) <= 1 &&
            std::abs(n.h - plane.y() * n.x - plane.z() * n.y) <= 2 * scale)
          ++agree;
      if (agree < 4) off(c, r) = 1;
    }
  });
  return off;
}

Grid<std::uint8_t> cells_of_islands(const Grid<float>& heights, std::int64_t max_cells, double max_step) {
  Grid<std::uint8_t> island(heights.columns(), heights.rows(), 0), seen = island;
  std::vector<std::pair<std::int64_t, std::int64_t>> patch;
  for (std::int64_t r = 0; r < heights.rows(); ++r)
    for (std::int64_t c = 0; c < heights.columns(); ++c) {
      if (seen(c, r) || std::isnan(heights(c, r))) continue;
      patch.assign(1, {c, r});
      seen(c, r) = 1;
      for (std::size_t next = 0; next < patch.size(); ++next) {
        const auto [x, y] = patch[next];
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
          const std::int64_t i = x + dx, j = y + dy;
          if (!heights.contains(i, j) || seen(i, j) || std::isnan(heights(i, j))) continue;
          if (!(std::abs(static_cast<double>(heights(i, j)) - static_cast<double>(heights(x, y))) <=
                max_step))
            continue;
          seen(i, j) = 1;
          patch.emplace_back(i, j);
        }
      }
      if (static_cast<std::int64_t>(patch.size()) <= max_cells)
        for (const auto& [x, y] : patch) island(x, y) = 1;
    }
  return island;
}

}  // namespace waymark::pipeline
