// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/laser_stems.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

/// Nothing hit is far away.
double range_at(const LaserScan& scan, std::size_t i) {
  const double r = static_cast<double>(scan.ranges[i]);
  return std::isfinite(r) && r > 0 && r < scan.most_range ? r : scan.most_range * 10;
}

}  // namespace

std::vector<Stem> find_stems(const LaserScan& scan, const LaserStems& options) {
  std::vector<Stem> stems;
  const std::size_t n = scan.ranges.size();
  for (std::size_t first = 0; first < n;) {
    std::size_t last = first;
    double sum = range_at(scan, first), nearest = sum;
    while (last + 1 < n && std::abs(range_at(scan, last + 1) - range_at(scan, last)) < options.jump) {
      ++last;
      sum += range_at(scan, last);
      nearest = std::min(nearest, range_at(scan, last));
    }
    const int beams = static_cast<int>(last - first) + 1;
    const double mean = sum / beams;
    // At the ends of the scan nobody knows what stands beside.
    const bool stands_out = first > 0 && last + 1 < n && range_at(scan, first - 1) > mean + options.clear &&
                            range_at(scan, last + 1) > mean + options.clear;
    const double width = beams * scan.angle_step * mean;
    if (stands_out && mean < options.most_range && width >= options.least_diameter &&
        width <= options.most_diameter) {
      const double middle = static_cast<double>(first + last) / 2;
      // The beams meet the near side: the middle lies half a diameter behind, less on average over the arc.
      stems.push_back({nearest + width / 2, scan.first_angle + middle * scan.angle_step, width, beams});
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
    s.range = stem.range;
    s.range_sd = options.range_sd;
    s.bearing = wrapped(stem.bearing);
    s.bearing_sd = options.bearing_sd;
    if (options.type) {
      constexpr std::size_t kDiameter = 1;
      const double beam = scan.angle_step * stem.range;  // a width is a whole number of beams
      s.features.value[kDiameter] = stem.diameter;
      s.features.variance[kDiameter] = beam * beam / 6 + 1e-4;
    }
    set.sightings.push_back(s);
  }
  return set;
}

}  // namespace waymark
