// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/horizon_summits.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {

std::vector<DetectedSummit> find_summits(const HorizonProfile& horizon, const HorizonSummitOptions& options) {
  std::vector<DetectedSummit> summits;
  const auto& e = horizon.elevations;
  const auto n = static_cast<std::ptrdiff_t>(e.size());
  if (n < 3 || !(horizon.angle_step > 0)) return summits;
  const bool ring = double(n) * horizon.angle_step > 2 * std::numbers::pi - 1.5 * horizon.angle_step;
  const auto at = [&](std::ptrdiff_t i) -> double {
    if (ring) i = (i % n + n) % n;
    return i >= 0 && i < n ? static_cast<double>(e[static_cast<std::size_t>(i)]) : std::nan("");
  };
  // Key col: lowest elevation on one side before the horizon rises above the summit. Skips unknown
  // elevations.
  const auto key = [&](std::ptrdiff_t i, std::ptrdiff_t step) {
    double lowest = at(i);
    for (std::ptrdiff_t k = 1; k < n; ++k) {
      const double v = at(i + k * step);
      if (!ring && (i + k * step < 0 || i + k * step >= n)) break;
      if (v > at(i) || (v == at(i) && step < 0)) break;
      if (v < lowest) lowest = v;
    }
    return lowest;
  };
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const double here = at(i), left = at(i - 1), right = at(i + 1);
    if (!(here > left) || !(here >= right)) continue;
    const double prominence = here - std::max(key(i, -1), key(i, 1));
    if (!(prominence >= std::max(options.min_prominence, 3 * horizon.elevation_sd))) continue;
    const double bend = left + right - 2 * here;
    const double off = bend < 0 ? std::clamp(0.5 * (left - right) / bend, -0.5, 0.5) : 0;
    DetectedSummit s{.bearing = wrap_angle(horizon.first_angle + (double(i) + off) * horizon.angle_step),
                     .elevation = here,
                     .prominence = prominence};
    // A flat top has a less precise bearing: where the horizon is within its noise of the summit.
    std::ptrdiff_t wide = 1;
    while (wide < n / 4 &&
           (at(i + wide) > here - 2 * horizon.elevation_sd || at(i - wide) > here - 2 * horizon.elevation_sd))
      ++wide;
    s.bearing_sd = horizon.angle_step * (0.3 + 0.3 * double(wide));
    summits.push_back(s);
  }
  std::ranges::stable_sort(summits, std::greater<>{}, &DetectedSummit::prominence);
  if (options.min_distance > 0) {
    std::vector<DetectedSummit> kept;
    for (const DetectedSummit& s : summits)
      if (std::ranges::none_of(kept, [&](const DetectedSummit& k) {
            return std::abs(wrap_angle(k.bearing - s.bearing)) < options.min_distance;
          }))
        kept.push_back(s);
    summits = std::move(kept);
  }
  return summits;
}

SightingSet sightings_of_summits(const HorizonProfile& horizon, const HorizonSummitOptions& options) {
  SightingSet set;
  for (const DetectedSummit& summit : find_summits(horizon, options)) {
    SeenLandmark s;
    s.type = options.type ? options.type : std::optional<TypeId>(kNoSuchType);
    s.bearing = summit.bearing;
    s.bearing_sd = summit.bearing_sd;
    s.elevation = summit.elevation;
    s.elevation_sd = horizon.elevation_sd;
    set.sightings.push_back(s);
  }
  set.horizon = std::make_shared<const HorizonProfile>(horizon);
  return set;
}

}  // namespace waymark::localization
