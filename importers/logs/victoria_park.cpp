// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "importers/logs/import_log.hpp"
#include "importers/logs/number_table.hpp"
#include "localization/robot_log.hpp"

namespace waymark::importers {

// Vehicle of Guivant & Nebot: wheelbase 2.83 m, encoder on the left rear wheel 0.76 m off the middle, laser
// 3.78 m ahead of the rear axle and 0.5 m to the left: the tracked point, since GPS fixes agree with
// it (0.98 m against 2.5 m at the axle, first 200 s). GPS columns are latitude, longitude: north, east. Beams
// run from -90 (right) to 90 degrees (left).
localization::RobotLog import_victoria_park(const std::filesystem::path& folder) {
  localization::RobotLog log;
  log.car = {2.83, 0.76, 3.78, 0.5};
  // Fitted for this car on the first 200 s.
  log.odometry = localization::OdometryNoise{
      .along_per_metre = 0.01, .across_per_metre = 0.001, .yaw_per_metre = 2e-4, .yaw_per_radian = 5e-3};
  log.shows_stems = true;
  const auto drive = number_table(folder / "DRS.txt", 3);
  for (std::size_t i = 0; i < drive.size(); i += 3)
    log.events.push_back({drive[i], localization::CarReading{drive[i + 1], drive[i + 2]}});
  constexpr std::size_t kBeams = 361;
  const auto scans = number_table(folder / "LASER.txt", kBeams + 1);
  for (std::size_t i = 0; i < scans.size(); i += kBeams + 1) {
    localization::LaserScan scan{.robot_from_sensor = {},
                                 .first_angle = -std::numbers::pi / 2,
                                 .angle_step = std::numbers::pi / 360,
                                 .ranges = std::vector<float>(kBeams),
                                 .max_range = 80};
    std::ranges::transform(scans.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                           scans.begin() + static_cast<std::ptrdiff_t>(i + kBeams) + 1, scan.ranges.begin(),
                           [](double range) { return static_cast<float>(range); });
    log.events.push_back({scans[i], std::move(scan)});
  }
  if (std::filesystem::exists(folder / "GPS.txt")) {
    const auto fixes = number_table(folder / "GPS.txt", 3);
    for (std::size_t i = 0; i < fixes.size(); i += 3)  // used as truth, hence not as a reading
      log.truth.push_back({fixes[i], {fixes[i + 2], fixes[i + 1], 0}});
  }
  std::ranges::stable_sort(log.events, {}, &localization::LogEvent::t);
  localization::clean_log(log);
  return log;
}

}  // namespace waymark::importers
