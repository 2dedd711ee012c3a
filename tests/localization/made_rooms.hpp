// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "localization/laser_scan.hpp"
namespace waymark::test {
using namespace localization;

/// A wall of a made floor plan.
struct MadeWall {
  Eigen::Vector2d from, to;
};

/// Returns the walls of a closed or open chain of points.
inline std::vector<MadeWall> chain(const std::vector<Eigen::Vector2d>& points) {
  std::vector<MadeWall> walls;
  for (std::size_t i = 1; i < points.size(); ++i) walls.push_back({points[i - 1], points[i]});
  return walls;
}

/// Returns the scan of a floor plan: each beam ends at the nearest wall that it meets.
inline LaserScan scan_walls(std::span<const MadeWall> walls, const Pose2& sensor, std::size_t beams = 361,
                            double field = 2 * std::numbers::pi, double sd = 0, std::uint64_t seed = 1) {
  Random random(seed, "scan");
  LaserScan scan{.robot_from_sensor = {},
                 .first_angle = -field / 2,
                 .angle_step = field / static_cast<double>(beams - 1),
                 .ranges = {},
                 .max_range = 30};
  for (std::size_t i = 0; i < beams; ++i) {
    const double angle = sensor.yaw + scan.first_angle + static_cast<double>(i) * scan.angle_step;
    const Eigen::Vector2d beam(std::cos(angle), std::sin(angle));
    double nearest = std::numeric_limits<double>::infinity();
    for (const MadeWall& wall : walls) {
      const Eigen::Vector2d along = wall.to - wall.from, off = wall.from - sensor.at();
      const double area = beam.x() * along.y() - beam.y() * along.x();
      if (std::abs(area) < 1e-12) continue;
      const double range = (off.x() * along.y() - off.y() * along.x()) / area;
      const double part = (off.x() * beam.y() - off.y() * beam.x()) / area;
      if (range > 0 && part >= 0 && part <= 1) nearest = std::min(nearest, range);
    }
    scan.ranges.push_back(std::isfinite(nearest) ? static_cast<float>(nearest + sd * random.normal()) : 0.0F);
  }
  return scan;
}

}  // namespace waymark::test
