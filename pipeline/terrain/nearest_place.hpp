// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <limits>
#include <optional>
#include <vector>
#include "pipeline/terrain/ground_metric.hpp"
namespace waymark {

/// The places that may be the nearest to an origin, ranked by straight-line distance, until exact distances
/// decide.
template <class Metric>
class NearestPlace {
 public:
  NearestPlace(const Metric& metric, Place origin) : metric_(metric), origin_(origin) {}

  /// No place at a squared straight-line distance beyond this can win.
  double limit() const { return limit_; }
  /// At most this far, m2; for a search that need not find anything farther.
  void stop_at(double squared) { limit_ = std::min(limit_, squared); }

  void offer(Place place, double squared) {
    if (!(squared <= limit_)) return;  // false for the NaN outside a projection
    places_.push_back({place, squared});
    if (squared >= best_) return;
    best_ = squared;
    const double metres = std::sqrt(squared), with_slack = metres + metric_.slack(metres);
    limit_ = std::min(limit_, with_slack * with_slack);
  }

  struct Found {
    Place place;
    double metres = 0;
  };
  /// The nearest by exact distance; of equals the first in row order.
  std::optional<Found> resolve() const {
    std::optional<Found> nearest;
    for (const auto& [place, squared] : places_) {
      if (squared > limit_) continue;
      const double metres = metric_.distance(origin_, place);
      if (!nearest || metres < nearest->metres ||
          (metres == nearest->metres && before(place, nearest->place)))
        nearest = {place, metres};
    }
    return nearest;
  }

 private:
  static bool before(Place a, Place b) { return a.row != b.row ? a.row < b.row : a.column < b.column; }

  struct Offer {
    Place place;
    double squared;
  };
  const Metric& metric_;
  Place origin_;
  double best_ = std::numeric_limits<double>::infinity(), limit_ = best_;
  std::vector<Offer> places_;
};

}  // namespace waymark
