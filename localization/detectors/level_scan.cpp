// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/level_scan.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace waymark {

std::vector<double> bridged_ranges(const LaserScan& scan, double jump) {
  const double far = scan.most_range * 10;
  std::vector<double> ranges;
  ranges.reserve(scan.ranges.size());
  for (const float told : scan.ranges) {
    const double r = static_cast<double>(told);
    ranges.push_back(std::isfinite(r) && r > 0 && r < scan.most_range ? r : far);
  }
  double before = ranges.empty() ? far : ranges[0];  // as it was before bridging
  for (std::size_t i = 1; i + 1 < ranges.size(); ++i) {
    const double a = before, b = ranges[i + 1];
    before = ranges[i];
    const bool speck = ranges[i] == far || ranges[i] < std::min(a, b) - jump;
    if (a < far && b < far && speck && std::abs(a - b) < jump) ranges[i] = (a + b) / 2;
  }
  return ranges;
}

RangeBearing on_level_ground(const LaserScan& scan, double range, double bearing) {
  if (scan.roll == 0 && scan.pitch == 0) return {range, bearing};
  const double yaw = scan.robot_from_sensor.yaw;
  const Eigen::Vector3d seen = range * Eigen::Vector3d(std::cos(bearing + yaw), std::sin(bearing + yaw), 0);
  const Eigen::Vector3d level = Eigen::AngleAxisd(scan.pitch, Eigen::Vector3d::UnitY()) *
                                (Eigen::AngleAxisd(scan.roll, Eigen::Vector3d::UnitX()) * seen);
  return {level.head<2>().norm(), std::atan2(level.y(), level.x()) - yaw};
}

}  // namespace waymark
