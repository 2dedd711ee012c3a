// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/laser_reflectors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "localization/detectors/scan_segments.hpp"

namespace waymark::localization {
namespace {

/// Returns the intensity from which a return is strong; `std::nullopt` without returns.
std::optional<float> strong_return(const LaserScan& scan, const LaserReflectorOptions& options) {
  std::vector<float> all;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i)
    if (std::isfinite(range_of(scan, i)) && std::isfinite(scan.intensities[i]))
      all.push_back(scan.intensities[i]);
  if (all.empty()) return {};
  const auto middle = all.begin() + std::ssize(all) / 2;
  std::ranges::nth_element(all, middle);
  return std::max(static_cast<float>(options.per_median) * *middle,
                  static_cast<float>(options.per_largest) * std::ranges::max(all));
}

/// Returns whether what stands beside a run is farther away. A beam without return shows nothing.
bool stands_free(const LaserScan& scan, const BeamSegment& run, double front, double clear) {
  if (run.first == 0 || run.last + 1 >= scan.ranges.size()) return false;
  // The beam beside it may hit both: the next one counts as well.
  const auto is_free = [&](std::size_t beside, std::ptrdiff_t step) {
    const auto next = static_cast<std::ptrdiff_t>(beside) + step;
    if (range_of(scan, beside) > front + clear) return true;
    return next >= 0 && next < std::ssize(scan.ranges) &&
           range_of(scan, static_cast<std::size_t>(next)) > front + clear;
  };
  return is_free(run.first - 1, -1) && is_free(run.last + 1, 1);
}

}  // namespace

std::vector<Reflector> find_reflectors(const LaserScan& scan, const LaserReflectorOptions& options) {
  if (scan.intensities.empty() || scan.intensities.size() != scan.ranges.size()) return {};
  const auto strong = strong_return(scan, options);
  if (!strong || !(*strong > 0)) return {};
  const auto is_strong = [&](std::size_t i) {
    return scan.intensities[i] >= *strong && range_of(scan, i) < options.max_range;
  };
  std::vector<Reflector> found;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    if (!is_strong(i)) continue;
    BeamSegment run{i, i};
    while (run.last + 1 < scan.ranges.size() && is_strong(run.last + 1) &&
           std::abs(range_of(scan, run.last + 1) - range_of(scan, run.last)) < options.jump)
      ++run.last;
    i = run.last;
    if (static_cast<int>(run.beams()) < options.min_beams) continue;
    const std::size_t skip = run.beams() / 3;
    double front = 0, bearing = 0, weight = 0;
    for (std::size_t k = run.first + skip; k <= run.last - skip; ++k)
      front += range_of(scan, k) / static_cast<double>(run.beams() - 2 * skip);
    for (std::size_t k = run.first; k <= run.last; ++k) {
      const auto strength = static_cast<double>(scan.intensities[k]);
      weight += strength, bearing += strength * (scan.first_angle + static_cast<double>(k) * scan.angle_step);
    }
    const double step = std::abs(scan.angle_step), beam = step * front;
    const double width =
        std::max(0.3 * step, static_cast<double>(run.beams()) * step - scan.beam_width.value_or(0));
    const double diameter = 2 * cylinder_radius(front, width);
    if (!(diameter <= options.max_diameter + beam) || !stands_free(scan, run, front, options.clear)) continue;
    Reflector reflector;
    reflector.diameter = std::min(diameter, options.max_diameter);
    reflector.diameter_sd = std::sqrt(beam * beam / 6 + 1e-4);  // a width is a whole number of beams
    reflector.range = front + reflector.diameter / 2;
    reflector.range_sd = std::hypot(0.02, reflector.diameter_sd / 2);
    reflector.bearing = bearing / weight;
    reflector.bearing_sd = std::hypot(step / std::sqrt(12.0), 0.003);
    reflector.beams = static_cast<int>(run.beams());
    found.push_back(reflector);
  }
  return found;
}

}  // namespace waymark::localization
