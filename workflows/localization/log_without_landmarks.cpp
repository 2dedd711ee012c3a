// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/log_without_landmarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace waymark::workflows {

std::string unusable_ranges_warning(const localization::RobotLog& log) {
  std::int64_t scans = 0, beams = 0, returns = 0, usable = 0;
  std::int64_t blind = 0;
  double first_blind = 0, last_blind = 0;
  double nearest = std::numeric_limits<double>::infinity(), max_range = 0;
  for (const localization::LogEvent& event : log.events) {
    const auto* scan = std::get_if<localization::LaserScan>(&event.what);
    if (!scan) continue;
    ++scans, beams += std::ssize(scan->ranges);
    max_range = std::max(max_range, scan->max_range);
    const bool is_blind =
        !scan->ranges.empty() && std::ranges::all_of(scan->ranges, [](float range) { return range <= 0; });
    if (is_blind) first_blind = blind++ == 0 ? event.t : first_blind, last_blind = event.t;
    for (const float range : scan->ranges) {
      if (!(std::isfinite(range) && range > 0)) continue;
      ++returns;
      if (range < scan->max_range)
        ++usable;
      else
        nearest = std::min(nearest, static_cast<double>(range));
    }
  }
  if (blind > 0 && blind < scans && 1000 * usable > returns)
    return fmt::format(
        "{} of the {} laser scans, at {:.3f} to {:.3f} s, have no range above 0 and show nothing", blind,
        scans, first_blind, last_blind);
  if (scans == 0 || (returns > 0 && 1000 * usable > returns)) return {};
  if (returns == 0)
    return fmt::format("none of the {} beams of the {} laser scans has a range above 0", beams, scans);
  return fmt::format(
      "{} of {} ranges of the {} laser scans lie below the scanner's {:g} m, the others begin at {:g}: "
      "ranges "
      "are metres, and most_range is the largest one that counts",
      usable, returns, scans, max_range, nearest);
}

std::string dead_reckoning_warning(const localization::RobotLog& log, const localization::Track& track) {
  if (log.graph || std::accumulate(track.verdicts.begin(), track.verdicts.end(), std::int64_t{0}) > 0)
    return {};
  std::int64_t scans = 0, sets = 0;
  for (const localization::LogEvent& event : log.events) {
    scans += std::holds_alternative<localization::LaserScan>(event.what);
    sets += std::holds_alternative<localization::SightingSet>(event.what);
  }
  const std::string what =
      scans > 0 ? fmt::format(
                      "no landmark is detected in the {} laser scans of the log (--set scans=NAME "
                      "chooses the detectors)",
                      scans)
      : sets > 0 ? fmt::format("the {} sets of sightings of the log are empty", sets)
                 : "the log has no sightings and no scans";
  return fmt::format("{}: the track is dead reckoning{}", what, track.fixes > 0 ? " with fixes" : "");
}

}  // namespace waymark::workflows
