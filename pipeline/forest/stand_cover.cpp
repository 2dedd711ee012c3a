// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/stand_cover.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/grid.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMaxPoints = 4e6;
constexpr std::int32_t kOutside = -3, kBare = -2,
                       kShared = -1;  // else index of the only crown over the point

/// Points at whole multiples of the step.
struct Lattice {
  double step = 1;
  std::int64_t column = 0, row = 0;  ///< of the first point, in steps
  std::int64_t columns = 0, rows = 0;

  double x(std::int64_t i) const { return static_cast<double>(column + i) * step; }
  double y(std::int64_t j) const { return static_cast<double>(row + j) * step; }
};

std::int64_t steps_up(double value, double step) {
  return static_cast<std::int64_t>(std::ceil(value / step));
}

Lattice lattice_over(const Eigen::AlignedBox2d& box, double step) {
  const double places = box.sizes().x() / step * (box.sizes().y() / step);
  if (places > kMaxPoints) step *= std::sqrt(places / kMaxPoints);
  step = std::max(step, box.sizes().maxCoeff() / kMaxPoints);  // a long, narrow stand
  Lattice grid{.step = step, .column = steps_up(box.min().x(), step), .row = steps_up(box.min().y(), step)};
  grid.columns = std::max<std::int64_t>(0, steps_up(box.max().x(), step) - grid.column);
  grid.rows = std::max<std::int64_t>(0, steps_up(box.max().y(), step) - grid.row);
  return grid;
}

/// Calls visit(i, j) for the points inside even-odd rings, row by row.
void fill(const Lattice& grid, std::span<const std::vector<Eigen::Vector2d>> rings, const auto& visit) {
  Eigen::AlignedBox2d box;
  for (const auto& ring : rings)
    for (const auto& corner : ring) box.extend(corner);
  if (box.isEmpty()) return;
  const std::int64_t first = std::max<std::int64_t>(0, steps_up(box.min().y(), grid.step) - grid.row);
  const std::int64_t last = std::min(grid.rows, steps_up(box.max().y(), grid.step) - grid.row);
  std::vector<double> crossings;
  for (std::int64_t j = first; j < last; ++j) {
    const double y = grid.y(j);
    crossings.clear();
    for (const auto& ring : rings)
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Eigen::Vector2d *low = &ring[k], *high = &ring[(k + 1) % ring.size()];
        if (low->y() > high->y()) std::swap(low, high);
        if (low->y() <= y && y < high->y())
          crossings.push_back(low->x() + (high->x() - low->x()) * (y - low->y()) / (high->y() - low->y()));
      }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      const std::int64_t from = std::max<std::int64_t>(0, steps_up(crossings[k], grid.step) - grid.column);
      const std::int64_t to = std::min(grid.columns, steps_up(crossings[k + 1], grid.step) - grid.column);
      for (std::int64_t i = from; i < to; ++i) visit(i, j);
    }
  }
}

void fill_circle(const Lattice& grid, const Eigen::Vector2d& middle, double radius, const auto& visit) {
  const std::int64_t first = std::max<std::int64_t>(0, steps_up(middle.y() - radius, grid.step) - grid.row);
  const std::int64_t last = std::min(grid.rows, steps_up(middle.y() + radius, grid.step) - grid.row);
  for (std::int64_t j = first; j < last; ++j) {
    const double dy = grid.y(j) - middle.y(), half = std::sqrt(std::max(0.0, radius * radius - dy * dy));
    const std::int64_t from = std::max<std::int64_t>(0, steps_up(middle.x() - half, grid.step) - grid.column);
    const std::int64_t to = std::min(grid.columns, steps_up(middle.x() + half, grid.step) - grid.column);
    for (std::int64_t i = from; i < to; ++i) visit(i, j);
  }
}

}  // namespace

Estimate canopy_cover(std::span<const StandCrown> crowns, const StandPolygon& stand, double step) {
  const Eigen::AlignedBox2d box = bounds(stand);
  if (box.isEmpty()) return {};
  const Lattice grid = lattice_over(box, step);
  Grid<std::int32_t> owner(grid.columns, grid.rows, kOutside);
  std::int64_t places = 0, covered = 0;
  fill(grid, stand.rings, [&](std::int64_t i, std::int64_t j) {
    owner(i, j) = kBare;
    ++places;
  });
  if (places == 0) return {};
  std::vector<std::int64_t> alone(crowns.size(), 0);
  for (std::size_t c = 0; c < crowns.size(); ++c) {
    const auto shade = [&](std::int64_t i, std::int64_t j) {
      std::int32_t& cell = owner(i, j);
      if (cell == kOutside || cell == kShared) return;
      if (cell == kBare) {
        cell = static_cast<std::int32_t>(c);
        ++alone[c];
        ++covered;
      } else {
        --alone[static_cast<std::size_t>(cell)];
        cell = kShared;
      }
    };
    const StandCrown& crown = crowns[c];
    if (!crown.ring.empty())
      fill(grid, std::span(&crown.ring, 1), shade);
    else if (crown.diameter > 0)
      fill_circle(grid, crown.position, crown.diameter / 2, shade);
  }
  const auto all = static_cast<double>(places);
  double variance = 0;
  for (std::size_t c = 0; c < crowns.size(); ++c) {
    const StandCrown& crown = crowns[c];
    const double fraction = static_cast<double>(alone[c]) / all;
    const double relative = crown.diameter > 0 ? 2 * crown.diameter_sd / crown.diameter : 0;
    variance += fraction * fraction * (crown.confidence * (1 - crown.confidence) + relative * relative);
  }
  return {static_cast<double>(covered) / all, std::sqrt(variance)};
}

}  // namespace waymark::pipeline
