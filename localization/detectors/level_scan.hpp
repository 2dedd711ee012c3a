// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "localization/laser_scan.hpp"
namespace waymark {

/// Ranges with ten times most_range where nothing was hit. A single beam that returned nothing, or something
/// nearer or farther than both neighbours by `jump`, while these agree to `jump`, takes their mean: dropouts,
/// specks and ranges from nowhere do not part a thing.
std::vector<double> bridged_ranges(const LaserScan& scan, double jump);

/// Neighbouring beams that hit one thing: first to last, both of it.
struct BeamRun {
  std::size_t first = 0, last = 0;
  std::size_t beams() const { return last - first + 1; }
};
/// The ranges of a scan cut wherever neighbours differ by `jump` or more, in order; every beam is in one run.
std::vector<BeamRun> runs_of(std::span<const double> ranges, double jump);

/// Angle that a run spans, rad: its beams less what their own width adds.
double width_of(const LaserScan& scan, std::size_t beams);
/// Radius of the cylinder that spans this angle and whose front is at this range (Ringdahl et al. 2013).
double cylinder_radius(double front, double width);

struct RangeBearing {
  double range = 0, bearing = 0;
};
/// Range and bearing on the plane of the map of what a tilted scanner saw (scan.roll, scan.pitch).
RangeBearing on_level_ground(const LaserScan& scan, double range, double bearing);

}  // namespace waymark
