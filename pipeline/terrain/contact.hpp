// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include "geo/dem_source.hpp"
#include "pipeline/terrain/ground_metric.hpp"
#include "pipeline/terrain/neighbourhood.hpp"
namespace waymark::pipeline {

/// Offers to `nearest` the point nearest to `from` on the contour of `level` around the higher cell (column,
/// row).
/// The terrain falls linearly from the cell to each of its eight neighbours, and the contour runs straight
/// between adjacent crossings. `height(column, row)` returns cell heights.
template <class Metric, class Nearest>
void offer_contacts(const Metric& metric, const Eigen::Vector3d& from, double level, std::int64_t column,
                    std::int64_t row, auto&& height, Nearest& nearest) {
  const double top = height(column, row);
  struct Crossing {
    GridPoint point;
    Eigen::Vector3d position;
  };
  std::array<std::optional<Crossing>, 8> crossings;
  const GridPoint here{static_cast<double>(column), static_cast<double>(row)};
  nearest.offer(here,
                (metric.position(here) - from).squaredNorm());  // if voids hide the slope
  for (std::size_t i = 0; i < kRing.size(); ++i) {
    const double foot = height(column + kRing[i].column, row + kRing[i].row);
    if (foot > level || foot == kNoHeight) continue;
    const double fraction = (top - level) / (top - foot);  // in (0, 1]
    const GridPoint point{static_cast<double>(column) + fraction * kRing[i].column,
                          static_cast<double>(row) + fraction * kRing[i].row};
    crossings[i] = {point, metric.position(point)};
  }
  for (std::size_t i = 0; i < kRing.size(); ++i) {
    if (!crossings[i]) continue;
    const auto& a = *crossings[i];
    nearest.offer(a.point, (a.position - from).squaredNorm());
    const auto& next = crossings[(i + 1) % kRing.size()];
    if (!next) continue;
    const Eigen::Vector3d along = next->position - a.position;
    const double length2 = along.squaredNorm();
    if (!(length2 > 0)) continue;
    const double t = along.dot(from - a.position) / length2;
    if (!(t > 0 && t < 1)) continue;
    const GridPoint point{a.point.column + t * (next->point.column - a.point.column),
                          a.point.row + t * (next->point.row - a.point.row)};
    nearest.offer(point, (a.position + t * along - from).squaredNorm());
  }
}

}  // namespace waymark::pipeline
