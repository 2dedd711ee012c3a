// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <limits>
#include <optional>
#include <vector>
#include "pipeline/terrain/ground_metric.hpp"
namespace waymark::pipeline {

/// Candidates for the nearest point to an origin, ranked by straight-line distance until exact distances
/// decide.
template <class Metric>
class NearestGridPoint {
 public:
  NearestGridPoint(const Metric& metric, GridPoint origin) : metric_(metric), origin_(origin) {}

  /// Returns the squared straight-line distance beyond which no candidate can be nearest.
  double limit() const { return limit_; }
  /// Limits the search to a squared distance, m2.
  void stop_at(double squared) { limit_ = std::min(limit_, squared); }

  void offer(GridPoint point, double squared) {
    if (!(squared <= limit_)) return;  // false for the NaN outside a projection
    points_.push_back({point, squared});
    if (squared >= best_) return;
    best_ = squared;
    const double metres = std::sqrt(squared), with_slack = metres + metric_.slack(metres);
    limit_ = std::min(limit_, with_slack * with_slack);
  }

  struct Found {
    GridPoint point;
    double metres = 0;
  };
  /// Returns the nearest by exact distance; among equals the first in row order.
  std::optional<Found> resolve() const {
    std::optional<Found> nearest;
    for (const auto& [point, squared] : points_) {
      if (squared > limit_) continue;
      const double metres = metric_.distance(origin_, point);
      if (!nearest || metres < nearest->metres ||
          (metres == nearest->metres && before(point, nearest->point)))
        nearest = {point, metres};
    }
    return nearest;
  }

 private:
  static bool before(GridPoint a, GridPoint b) {
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  }

  struct Offer {
    GridPoint point;
    double squared;
  };
  const Metric& metric_;
  GridPoint origin_;
  double best_ = std::numeric_limits<double>::infinity(), limit_ = best_;
  std::vector<Offer> points_;
};

}  // namespace waymark::pipeline
