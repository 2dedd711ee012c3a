// SPDX-License-Identifier: Apache-2.0
#include "localization/global/terrain_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::localization {
namespace {

constexpr int kProbes = 64;

/// Returns whether any terrain is known between two positions.
bool known_between(const TerrainHeight& ground, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  for (int i = 0; i <= kProbes; ++i)
    if (ground(a + (b - a) * i / kProbes)) return true;
  return false;
}

void widen(const TerrainHeight& ground, Eigen::AlignedBox2d& box, double beyond) {
  const Eigen::AlignedBox2d first = box;
  const double step = std::max(beyond / 50, 1e-3);
  for (int axis = 0; axis < 2; ++axis)
    for (const int direction : {-1, 1})
      for (double far = step; far <= beyond; far += step) {
        Eigen::Vector2d a = box.min(), b = box.max();
        a[axis] = b[axis] = direction < 0 ? first.min()[axis] - far : first.max()[axis] + far;
        if (!known_between(ground, a, b)) break;
        (direction < 0 ? box.min() : box.max())[axis] = a[axis];
      }
}

constexpr std::uint8_t kOutside = 255;

/// Marks the unknown cells that are connected to the edge of the grid: sea and what lies beyond the DEM.
Grid<std::uint8_t> find_outside(const Grid<float>& heights) {
  Grid<std::uint8_t> marks(heights.columns(), heights.rows(), 0);
  std::vector<std::pair<std::int64_t, std::int64_t>> open;
  const auto visit = [&](std::int64_t c, std::int64_t r) {
    if (!heights.contains(c, r) || marks(c, r) || std::isfinite(heights(c, r))) return;
    marks(c, r) = kOutside;
    open.emplace_back(c, r);
  };
  for (std::int64_t c = 0; c < heights.columns(); ++c) visit(c, 0), visit(c, heights.rows() - 1);
  for (std::int64_t r = 0; r < heights.rows(); ++r) visit(0, r), visit(heights.columns() - 1, r);
  while (!open.empty()) {
    const auto [c, r] = open.back();
    open.pop_back();
    visit(c - 1, r), visit(c + 1, r), visit(c, r - 1), visit(c, r + 1);
  }
  return marks;
}

std::optional<float> mean_of_neighbours(const Grid<float>& heights, std::int64_t c, std::int64_t r) {
  double sum = 0;
  int known = 0;
  for (std::int64_t y = r - 1; y <= r + 1; ++y)
    for (std::int64_t x = c - 1; x <= c + 1; ++x)
      if (heights.contains(x, y) && std::isfinite(heights(x, y)))
        sum += static_cast<double>(heights(x, y)), ++known;
  if (known == 0) return {};
  return static_cast<float>(sum / known);
}

/// Fills holes ring by ring from their margins by means of neighbours. Returns the ring of each cell; 0: not
/// filled.
Grid<std::uint8_t> fill_holes(Grid<float>& heights, int max_rings) {
  Grid<std::uint8_t> rings = find_outside(heights);
  struct Cell {
    std::int64_t column, row;
    float height;
  };
  std::vector<Cell> ring(1);
  for (int number = 1; number <= max_rings && !ring.empty(); ++number) {
    ring.clear();
    for (std::int64_t r = 0; r < heights.rows(); ++r)
      for (std::int64_t c = 0; c < heights.columns(); ++c)
        if (!std::isfinite(heights(c, r)) && rings(c, r) != kOutside)
          if (const auto h = mean_of_neighbours(heights, c, r)) ring.push_back({c, r, *h});
    for (const Cell& cell : ring) {
      heights(cell.column, cell.row) = cell.height;
      rings(cell.column, cell.row) = static_cast<std::uint8_t>(number);
    }
  }
  std::ranges::replace(rings.cells(), kOutside, std::uint8_t{0});
  return rings;
}

}  // namespace

TerrainGrid::TerrainGrid(const TerrainHeight& ground, Eigen::AlignedBox2d box, double beyond,
                         std::int64_t max_cells)
    : area_(box) {
  if (area_.isEmpty()) return;
  widen(ground, area_, beyond);
  cell_ = std::max(area_.sizes().maxCoeff() / static_cast<double>(max_cells), 1e-3);
  const auto columns = static_cast<std::int64_t>(area_.sizes().x() / cell_) + 2,
             rows = static_cast<std::int64_t>(area_.sizes().y() / cell_) + 2;
  columns_ = static_cast<double>(columns - 1), rows_ = static_cast<double>(rows - 1);
  heights_ = Grid<float>(columns, rows, std::numeric_limits<float>::quiet_NaN());
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t c = 0; c < columns; ++c)
      if (const auto h = ground(area_.min() + cell_ * Eigen::Vector2d(double(c), double(r))))
        heights_(c, r) = static_cast<float>(*h);
  gaps_ = fill_holes(heights_, kMaxGap);
  blocks_.push_back(heights_);
  for (float& h : blocks_[0].cells())
    if (!std::isfinite(h)) h = kNone;
  while (blocks_.back().columns() > 1 || blocks_.back().rows() > 1) {
    const Grid<float>& fine = blocks_.back();
    Grid<float> coarse((fine.columns() + 1) / 2, (fine.rows() + 1) / 2, kNone);
    for (std::int64_t r = 0; r < fine.rows(); ++r)
      for (std::int64_t c = 0; c < fine.columns(); ++c)
        coarse(c / 2, r / 2) = std::max(coarse(c / 2, r / 2), fine(c, r));
    blocks_.push_back(std::move(coarse));
  }
  summit_ = static_cast<double>(blocks_.back()(0, 0));
}

}  // namespace waymark::localization
