// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/laser_stems.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "localization/detectors/level_scan.hpp"

namespace waymark {
namespace {

// The cylinder of this angular width seen over some beams.
Stem stem_of(std::span<const double> ranges, double first_bearing, double step, double width) {
  Stem stem;
  const auto n = ranges.size();
  stem.beams = static_cast<int>(n);
  stem.bearing = first_bearing + 0.5 * step * static_cast<double>(n - 1);
  const double half_sine = std::sin(std::min(width, 2.0) / 2);
  // The nearest of a few noisy ranges lies before the stem, the mean of all behind its front: the middle third
  // is nearly flat.
  double front = 0;
  const std::size_t skip = n / 3;
  for (std::size_t i = skip; i < n - skip; ++i) front += ranges[i];
  front /= static_cast<double>(n - 2 * skip);
  stem.diameter = 2 * front * half_sine / (1 - half_sine);

  const double radius = stem.diameter / 2;
  const auto middle_from = [&](std::size_t i) {
    const double off = step * (static_cast<double>(i) - 0.5 * static_cast<double>(n - 1));
    const double across = ranges[i] * std::sin(off);
    return ranges[i] * std::cos(off) + std::sqrt(std::max(0.0, radius * radius - across * across));
  };
  double sum = 0, squares = 0;
  for (std::size_t i = skip; i < n - skip; ++i) sum += middle_from(i);
  stem.range = sum / static_cast<double>(n - 2 * skip);
  for (std::size_t i = 0; i < n; ++i) squares += std::pow(middle_from(i) - stem.range, 2);
  stem.roughness = std::sqrt(squares / static_cast<double>(n));

  // A width is a whole number of beams: the count errs by up to one, its variance is 1/6 beam squared.
  const double beam = step * stem.range;
  stem.diameter_sd = std::sqrt(beam * beam / 6 + 1e-4);
  stem.range_sd = std::sqrt(0.25 * stem.diameter_sd * stem.diameter_sd + 0.02 * 0.02);
  stem.bearing_sd = std::sqrt(step * step / 12 + 0.003 * 0.003);
  return stem;
}

}  // namespace

LaserStems forest_stems() {
  return {.type = {},
          .jump = 0.35,
          .clear = 0.4,
          .most_diameter = 1.5,
          .least_diameter = 0.05,
          .most_range = 25,
          .roughness = 0.06,
          .least_beams = 3,
          .range_sd = 0,
          .bearing_sd = 0};
}

std::vector<Stem> find_stems(const LaserScan& scan, const LaserStems& options) {
  std::vector<Stem> stems;
  const std::vector<double> ranges = bridged_ranges(scan, options.jump);
  const std::size_t n = ranges.size();
  for (std::size_t first = 0; first < n;) {
    std::size_t last = first;
    double sum = ranges[first];
    while (last + 1 < n && std::abs(ranges[last + 1] - ranges[last]) < options.jump) sum += ranges[++last];
    const int beams = static_cast<int>(last - first) + 1;
    const double mean = sum / beams;
    // At the ends of the scan nobody knows what stands beside.
    const bool stands_out = first > 0 && last + 1 < n && ranges[first - 1] > mean + options.clear &&
                            ranges[last + 1] > mean + options.clear;
    if (stands_out && mean < options.most_range && beams >= options.least_beams) {
      const double width = std::max(0.3 * scan.angle_step, beams * scan.angle_step - scan.beam_width.value_or(0));
      const Stem stem = stem_of({ranges.data() + first, static_cast<std::size_t>(beams)},
                                scan.first_angle + static_cast<double>(first) * scan.angle_step,
                                scan.angle_step, width);
      if (stem.diameter >= options.least_diameter && stem.diameter <= options.most_diameter &&
          stem.roughness <= options.roughness)
        stems.push_back(stem);
    }
    first = last + 1;
  }
  return stems;
}

SightingSet sightings_of_stems(const LaserScan& scan, const LaserStems& options) {
  SightingSet set{scan.robot_from_sensor, {}};
  for (const Stem& stem : find_stems(scan, options)) {
    SeenLandmark s;
    s.type = options.type;
    const auto [range, bearing] = on_level_ground(scan, stem.range, stem.bearing);
    s.range = range;
    s.range_sd = options.range_sd > 0 ? options.range_sd : stem.range_sd;
    s.bearing = wrapped(bearing);
    s.bearing_sd = options.bearing_sd > 0 ? options.bearing_sd : stem.bearing_sd;
    if (options.type) {
      constexpr std::size_t kDiameter = 1;
      s.features.value[kDiameter] = stem.diameter;
      s.features.variance[kDiameter] = stem.diameter_sd * stem.diameter_sd;
    }
    set.sightings.push_back(s);
  }
  return set;
}

}  // namespace waymark
