// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/scan_segments.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::localization {

double range_of(const LaserScan& scan, std::size_t beam) {
  const auto r = static_cast<double>(scan.ranges[beam]);
  return std::isfinite(r) && r > 0 && r < scan.max_range ? r : std::numeric_limits<double>::infinity();
}

std::vector<double> bridge_outliers(const LaserScan& scan, double jump) {
  const double far = scan.max_range * 10;
  std::vector<double> ranges;
  ranges.reserve(scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) ranges.push_back(std::min(range_of(scan, i), far));
  double before = ranges.empty() ? far : ranges[0];  // as it was before bridging
  for (std::size_t i = 1; i + 1 < ranges.size(); ++i) {
    const double a = before, b = ranges[i + 1];
    before = ranges[i];
    const bool speck = ranges[i] < std::min(a, b) - jump || ranges[i] > std::max(a, b) + jump;
    if (a < far && b < far && speck && std::abs(a - b) < jump) ranges[i] = (a + b) / 2;
  }
  return ranges;
}

std::vector<BeamSegment> split_at_jumps(std::span<const double> ranges, double jump, double jump_per_metre) {
  std::vector<BeamSegment> runs;
  for (std::size_t first = 0; first < ranges.size();) {
    std::size_t last = first;
    const auto joined = [&](double a, double b) {
      return std::abs(b - a) < jump + jump_per_metre * std::min(a, b);
    };
    while (last + 1 < ranges.size() && joined(ranges[last], ranges[last + 1])) ++last;
    runs.push_back({first, last});
    first = last + 1;
  }
  return runs;
}

double angular_width(const LaserScan& scan, std::size_t beams) {
  return std::max(0.3 * scan.angle_step,
                  static_cast<double>(beams) * scan.angle_step - scan.beam_width.value_or(0));
}

double cylinder_radius(double front, double width) {
  const double half_sine = std::sin(std::min(width, 2.0) / 2);
  return front * half_sine / (1 - half_sine);
}

SeenLandmark sighting_of_point(const LaserScan& scan, const Eigen::Vector2d& at,
                               const Eigen::Matrix2d& covariance) {
  SeenLandmark s;
  const double range = std::max(at.norm(), 1e-3);
  const Eigen::Vector2d radial = at / range, across(-radial.y(), radial.x());
  const auto [level_range, bearing] = level_range_bearing(scan, range, std::atan2(at.y(), at.x()));
  s.range = level_range;
  s.bearing = wrap_angle(bearing);
  s.range_sd = std::sqrt(std::max(radial.dot(covariance * radial), 1e-8));
  s.bearing_sd = std::sqrt(std::max(across.dot(covariance * across), 1e-8)) / range;
  return s;
}

RangeBearing level_range_bearing(const LaserScan& scan, double range, double bearing) {
  if (scan.roll == 0 && scan.pitch == 0) return {range, bearing};
  const double yaw = scan.robot_from_sensor.yaw;
  const Eigen::Vector3d seen = range * Eigen::Vector3d(std::cos(bearing + yaw), std::sin(bearing + yaw), 0);
  const Eigen::Vector3d level = Eigen::AngleAxisd(scan.pitch, Eigen::Vector3d::UnitY()) *
                                (Eigen::AngleAxisd(scan.roll, Eigen::Vector3d::UnitX()) * seen);
  return {level.head<2>().norm(), std::atan2(level.y(), level.x()) - yaw};
}

}  // namespace waymark::localization
