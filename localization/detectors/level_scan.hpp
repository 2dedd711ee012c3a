// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/laser_scan.hpp"
namespace waymark {

/// Ranges with ten times most_range where nothing was hit. A single beam that returned nothing, or something
/// nearer than both neighbours by `jump`, while these agree to `jump`, takes their mean: dropouts and specks
/// do not part a thing.
std::vector<double> bridged_ranges(const LaserScan& scan, double jump);

struct RangeBearing {
  double range = 0, bearing = 0;
};
/// Range and bearing on the plane of the map of what a tilted scanner saw (scan.roll, scan.pitch).
RangeBearing on_level_ground(const LaserScan& scan, double range, double bearing);

}  // namespace waymark
