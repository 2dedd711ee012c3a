// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "localization/laser_scan.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Returns the range of a beam, m; infinity without a return.
double range_of(const LaserScan& scan, std::size_t beam);

/// Returns the ranges with ten times max_range where there was no return, and with single outliers
/// bridged. A beam that differs from both neighbours by `jump`, while these agree to `jump`, takes their
/// mean: dropouts and specks do not split an object.
std::vector<double> bridge_outliers(const LaserScan& scan, double jump);

/// Consecutive beams, `first` to `last`, that hit one object.
struct BeamSegment {
  std::size_t first = 0, last = 0;
  std::size_t beams() const { return last - first + 1; }
};
/// Splits the ranges of a scan wherever neighbours differ by `jump`, plus `jump_per_metre` times the nearer
/// range, or more, in order. Every beam is in one run.
std::vector<BeamSegment> split_at_jumps(std::span<const double> ranges, double jump,
                                        double jump_per_metre = 0);

/// Returns the angle that a run spans, rad: its beams less their own width.
double angular_width(const LaserScan& scan, std::size_t beams);
/// Returns the radius of the cylinder that spans this angle and whose front is at this range (Ringdahl et
/// al. 2013).
double cylinder_radius(double front, double width);

struct RangeBearing {
  double range = 0, bearing = 0;
};
/// Returns the sighting of a point in the frame of the sensor, metres; `covariance` in m^2.
SeenLandmark sighting_of_point(const LaserScan& scan, const Eigen::Vector2d& at,
                               const Eigen::Matrix2d& covariance);
/// Projects a range and bearing of a tilted scanner (scan.roll, scan.pitch) to the map plane.
RangeBearing level_range_bearing(const LaserScan& scan, double range, double bearing);

}  // namespace waymark::localization
