// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/drive.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace waymark::testbed {

PathDrive drive_along(const Terrain& terrain, std::span<const RockSolid> rocks,
                      std::span<const Eigen::Vector2d> path, const DriveSettings& settings,
                      std::uint64_t seed) {
  if (path.size() < 2) throw Error(ErrorCode::usage, "a drive needs a path of at least two points", "drive");
  const Eigen::Vector2d first = path[std::min<std::size_t>(path.size() - 1, 4)] - path[0];
  const auto vehicle = make_motion(terrain, rocks, settings,
                                   {path[0].x(), path[0].y(), std::atan2(first.y(), first.x())}, seed);
  PathPursuit pursuit({path.begin(), path.end()}, settings.speed);
  PathDrive drive;
  const auto limit = static_cast<std::size_t>(3e5);
  while (drive.steps.size() < limit) {
    const auto command = pursuit.command(vehicle->now().at.plane);
    drive.mishap = vehicle->mishap();
    if (!command || !drive.mishap.empty()) {
      drive.steps.push_back(vehicle->now());
      return drive;
    }
    drive.steps.push_back(vehicle->step(*command));
  }
  throw Error(ErrorCode::usage, "the drive does not reach the end of its path", "drive",
              "a slower turn needs more room: fewer waypoints, or more speed");
}

}  // namespace waymark::testbed
