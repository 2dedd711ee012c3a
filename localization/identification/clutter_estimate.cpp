// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/clutter_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {
namespace {

constexpr double kKept = 1 - 1.0 / 50;                // of the past, per set
constexpr double kLeastRange = 1, kLeastTurn = 0.35;  // m, rad: of a view
constexpr double kPrior = 1;  // sightings of the map, and not of it, before any is known

}  // namespace

void ClutterEstimate::add_sightings(const SightingSet& seen) {
  for (double* sum : {&sets_, &sightings_, &ranged_, &squared_range_, &squared_bearing_}) *sum *= kKept;
  ++sets_;
  for (const SeenLandmark& s : seen.sightings) {
    if (!s.is_valid()) continue;
    ++sightings_;
    squared_bearing_ += s.bearing * s.bearing;
    if (!s.range) continue;
    ++ranged_;
    squared_range_ += *s.range * *s.range;
  }
}

void ClutterEstimate::add_unmapped(double unmapped, double count) {
  unmapped_ = kKept * unmapped_ + unmapped;
  matched_ = kKept * matched_ + count - unmapped;
}

double ClutterEstimate::density(double bearing_reach) const {
  if (!(sightings_ > 0)) return 0;
  const double fraction = (unmapped_ + kPrior) / (unmapped_ + matched_ + 2 * kPrior);
  const double range = ranged_ > 0 ? std::sqrt(3 * squared_range_ / ranged_) : bearing_reach;
  const double turn = 2 * std::sqrt(3 * squared_bearing_ / sightings_);
  return fraction * sightings_ / sets_ / (std::max(range, kLeastRange) * std::max(turn, kLeastTurn));
}

}  // namespace waymark::localization
