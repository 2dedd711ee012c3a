// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/laser_stems.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "localization/detectors/scan_segments.hpp"

namespace waymark::localization {
namespace {

// Fits a cylinder of this angular width to some beams.
Stem stem_of(std::span<const double> ranges, double first_bearing, double step, double width) {
  Stem stem;
  const auto n = ranges.size();
  stem.beams = static_cast<int>(n);
  stem.bearing = first_bearing + 0.5 * step * static_cast<double>(n - 1);
  // The nearest of a few noisy ranges lies in front of the stem, their mean behind its front. The middle
  // third is nearly flat.
  double front = 0;
  const std::size_t skip = n / 3;
  for (std::size_t i = skip; i < n - skip; ++i) front += ranges[i];
  front /= static_cast<double>(n - 2 * skip);
  stem.diameter = 2 * cylinder_radius(front, width);

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

  // A width is a whole number of beams: its error is at most one beam, its variance 1/6 beam squared.
  const double beam = step * stem.range;
  stem.diameter_sd = std::sqrt(beam * beam / 6 + 1e-4);
  stem.range_sd = std::sqrt(0.25 * stem.diameter_sd * stem.diameter_sd + 0.02 * 0.02);
  stem.bearing_sd = std::sqrt(step * step / 12 + 0.003 * 0.003);
  return stem;
}

// Returns whether the background on both sides is farther away. One side may be nearer if the stem is
// whole: then its last beam there lies as far behind the front as a stem's edge. At the ends of the scan
// the background is unknown.
bool stands_out(std::span<const double> ranges, const BeamSegment& run, double mean,
                const LaserStemOptions& options) {
  const auto [first, last] = run;
  if (first == 0 || last + 1 >= ranges.size()) return false;
  const double before = ranges[first - 1], after = ranges[last + 1];
  const bool clear_before = before > mean + options.clear, clear_after = after > mean + options.clear;
  if (clear_before && clear_after) return true;
  if (!options.partly_hidden || clear_before == clear_after || last - first < 5) return false;
  const bool at_end = clear_before;  // which side is hidden
  if (!((at_end ? after : before) < mean - options.clear)) return false;
  double front = ranges[first];
  for (std::size_t i = first; i <= last; ++i) front = std::min(front, ranges[i]);
  const double hidden = ranges[at_end ? last : first] - front, open = ranges[at_end ? first : last] - front;
  return hidden > 0.5 * open && hidden > 0.05;
}

}  // namespace

LaserStemOptions forest_stem_options() {
  return {.type = {},
          .diameter_feature = 1,
          .jump = 0.35,
          .clear = 0.4,
          .max_diameter = 1.5,
          .min_diameter = 0.05,
          .max_range = 25,
          .roughness = 0.06,
          .roughness_base = 0.025,
          .roughness_per_metre = 0.15,
          .min_beams = 3,
          .range_sd = 0,
          .bearing_sd = 0,
          .partly_hidden = true};
}

LaserStemOptions post_options() {
  LaserStemOptions options = forest_stem_options();
  options.jump = 0.3;
  options.min_diameter = 0.04, options.max_diameter = 0.3;
  options.max_range = 30;
  options.partly_hidden = false;
  return options;
}

LaserStemOptions pillar_options() {
  LaserStemOptions options = post_options();
  options.min_diameter = 0.3, options.max_diameter = 2;
  options.roughness_base = 0.03, options.roughness_per_metre = 0.02;
  options.min_beams = 5;
  return options;
}

std::vector<Stem> find_stems(const LaserScan& scan, const LaserStemOptions& options) {
  std::vector<Stem> stems;
  const std::vector<double> ranges = bridge_outliers(scan, options.jump);
  for (const BeamSegment& run : split_at_jumps(ranges, options.jump)) {
    const std::span<const double> hits(ranges.data() + run.first, run.beams());
    const double mean = std::accumulate(hits.begin(), hits.end(), 0.0) / static_cast<double>(hits.size());
    if (!stands_out(ranges, run, mean, options) || !(mean < options.max_range) ||
        static_cast<int>(run.beams()) < options.min_beams)
      continue;
    const Stem stem = stem_of(hits, scan.first_angle + static_cast<double>(run.first) * scan.angle_step,
                              scan.angle_step, angular_width(scan, run.beams()));
    if (stem.diameter >= options.min_diameter && stem.diameter <= options.max_diameter &&
        stem.roughness <=
            std::min(options.roughness, options.roughness_base + options.roughness_per_metre * stem.diameter))
      stems.push_back(stem);
  }
  return stems;
}

SightingSet sightings_of_stems(const LaserScan& scan, const LaserStemOptions& options) {
  SightingSet set{scan.robot_from_sensor, {}};
  for (const Stem& stem : find_stems(scan, options)) {
    SeenLandmark s;
    s.type = options.type;
    const auto [range, bearing] = level_range_bearing(scan, stem.range, stem.bearing);
    s.range = range;
    s.range_sd = options.range_sd > 0 ? options.range_sd : stem.range_sd;
    s.bearing = wrap_angle(bearing);
    s.bearing_sd = options.bearing_sd > 0 ? options.bearing_sd : stem.bearing_sd;
    if (options.type) {
      s.features.value[options.diameter_feature] = stem.diameter;
      s.features.variance[options.diameter_feature] = stem.diameter_sd * stem.diameter_sd;
    }
    set.sightings.push_back(s);
  }
  return set;
}

}  // namespace waymark::localization
