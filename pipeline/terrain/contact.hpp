// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include "geo/dem_source.hpp"
#include "pipeline/terrain/ground_metric.hpp"
#include "pipeline/terrain/neighbourhood.hpp"
namespace waymark {

/// Offers to `nearest` the point nearest to `from` of the ground above `level` around the higher cell
/// (column, row): the ground falls linearly from it to each of its eight neighbours, and the contour runs
/// straight between the crossings of two adjacent ones. `height(column, row)` gives cell heights.
template <class Metric, class Nearest>
void offer_contacts(const Metric& metric, const Eigen::Vector3d& from, double level, std::int64_t column,
                    std::int64_t row, auto&& height, Nearest& nearest) {
  const double top = height(column, row);
  struct Crossing {
    Place place;
    Eigen::Vector3d position;
  };
  std::array<std::optional<Crossing>, 8> crossings;
  const Place here{static_cast<double>(column), static_cast<double>(row)};
  nearest.offer(here,
                (metric.position(here) - from).squaredNorm());  // the nearest where voids hide the slope
  for (std::size_t i = 0; i < kRing.size(); ++i) {
    const double foot = height(column + kRing[i].column, row + kRing[i].row);
    if (foot > level || foot == kNoHeight) continue;
    const double share = (top - level) / (top - foot);  // in (0, 1]
    const Place place{static_cast<double>(column) + share * kRing[i].column,
                      static_cast<double>(row) + share * kRing[i].row};
    crossings[i] = {place, metric.position(place)};
  }
  for (std::size_t i = 0; i < kRing.size(); ++i) {
    if (!crossings[i]) continue;
    const auto& a = *crossings[i];
    nearest.offer(a.place, (a.position - from).squaredNorm());
    const auto& next = crossings[(i + 1) % kRing.size()];
    if (!next) continue;
    const Eigen::Vector3d along = next->position - a.position;
    const double length2 = along.squaredNorm();
    if (!(length2 > 0)) continue;
    const double t = along.dot(from - a.position) / length2;
    if (!(t > 0 && t < 1)) continue;
    const Place place{a.place.column + t * (next->place.column - a.place.column),
                      a.place.row + t * (next->place.row - a.place.row)};
    nearest.offer(place, (a.position + t * along - from).squaredNorm());
  }
}

}  // namespace waymark
