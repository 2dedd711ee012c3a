// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/drive_looks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

namespace waymark::workflows {
namespace {

using localization::SeenLandmark;

constexpr double kBeamSlack = 0.1;    // m by which a beam may end before a landmark that it shows
constexpr double kMinCosine = 0.3;    // of the angle between the open side and the sensor
constexpr double kMaxTilt = 0.1;      // rad, of a scanner whose beams stay at the height of an upright object
constexpr double kMinReturned = 0.6;  // of the beams through a place; what absorbs them would not be empty

/// Returns the beam nearest to a bearing of the sensor; `std::nullopt` outside of the scan.
std::optional<std::size_t> beam_towards(const localization::LaserScan& scan, double bearing) {
  const double turn = std::remainder(bearing - scan.first_angle, 2 * std::numbers::pi);
  for (const double angle : {turn, turn + 2 * std::numbers::pi, turn - 2 * std::numbers::pi}) {
    const double beam = std::round(angle / scan.angle_step);
    if (beam >= 0 && beam < static_cast<double>(scan.ranges.size())) return static_cast<std::size_t>(beam);
  }
  return std::nullopt;
}

}  // namespace

std::vector<DriveLook> looks_of_drive(const localization::RobotLog& log,
                                      std::span<const localization::StampedPose> poses,
                                      const localization::ScanDetector& detect, const std::string& name,
                                      const DriveMappingOptions& options) {
  std::vector<DriveLook> looks;
  std::set<std::string> names;
  std::optional<localization::Pose2> last;
  double last_time = std::numeric_limits<double>::quiet_NaN();
  for (const localization::LogEvent& event : log.events) {
    const auto* scan = std::get_if<localization::LaserScan>(&event.what);
    const auto* seen = std::get_if<localization::SightingSet>(&event.what);
    if (!seen && !(scan && detect)) continue;
    const auto robot = localization::pose_at(poses, event.t, options.max_gap);
    if (!robot) continue;
    const bool is_near = last && (robot->at() - last->at()).norm() < options.min_step &&
                         std::abs(localization::wrap_angle(robot->yaw - last->yaw)) < options.min_turn;
    if (is_near && event.t != last_time) continue;  // several sensors look at one time
    last = robot, last_time = event.t;
    DriveLook look{.name = fmt::format("{}@{:.3f}", name, event.t),
                   .map_from_sensor = {},
                   .seen = scan ? detect(*scan) : *seen,
                   .scan = scan ? *scan : localization::LaserScan{}};
    while (!names.insert(look.name).second) look.name += "+";
    look.map_from_sensor = *robot * (scan ? scan->robot_from_sensor : seen->robot_from_sensor);
    looks.push_back(std::move(look));
  }
  return looks;
}

bool covers(const DriveLook& look, const Eigen::Vector2d& at, double direction, double max_range) {
  const Eigen::Vector2d to = at - look.map_from_sensor.at();
  const double range = to.norm();
  if (!(range <= max_range && range > 0)) return false;
  const double north = std::numbers::pi / 2 - direction;  // direction in the frame of the map, from x to y
  if (std::isfinite(direction) &&
      -to.dot(Eigen::Vector2d(std::cos(north), std::sin(north))) < kMinCosine * range)
    return false;
  const double bearing = localization::wrap_angle(std::atan2(to.y(), to.x()) - look.map_from_sensor.yaw);
  const localization::LaserScan& scan = look.scan;
  if (scan.ranges.empty())  // within the bearings of the sightings
    return std::ranges::any_of(look.seen.sightings,
                               [&](const SeenLandmark& s) { return s.bearing && *s.bearing >= bearing; }) &&
           std::ranges::any_of(look.seen.sightings,
                               [&](const SeenLandmark& s) { return s.bearing && *s.bearing <= bearing; });
  const auto beam = beam_towards(scan, bearing);
  if (!beam) return false;
  const auto reached = static_cast<double>(scan.ranges[*beam]);
  return std::isfinite(reached) && reached > 0 && reached >= range - kBeamSlack;
}

bool sees_through(const DriveLook& look, const Eigen::Vector2d& at, double radius,
                  const DriveMappingOptions& options) {
  const localization::LaserScan& scan = look.scan;
  const Eigen::Vector2d to = at - look.map_from_sensor.at();
  const double range = to.norm(), step = std::abs(scan.angle_step);
  const double side = radius + 2 * std::hypot(options.position_sd, options.yaw_sd * range);
  // Four beams cross the object: none of its parts hides between two.
  if (!(radius > 0 && side < range / 2 && step > 0 && step * range <= radius / 2)) return false;
  if (scan.ranges.empty() || std::abs(scan.roll) > kMaxTilt || std::abs(scan.pitch) > kMaxTilt) return false;
  const double bearing = localization::wrap_angle(std::atan2(to.y(), to.x()) - look.map_from_sensor.yaw);
  const double half = std::asin(side / range);
  int beams = 0, behind = 0;
  for (double off = -half; off <= half; off += step) {
    const auto beam = beam_towards(scan, bearing + off);
    if (!beam) return false;
    ++beams;
    const auto reached = static_cast<double>(scan.ranges[*beam]);
    if (!(std::isfinite(reached) && reached > 0 && reached < scan.max_range)) continue;  // no return
    if (!(reached > range + radius + kBeamSlack)) return false;
    ++behind;
  }
  return behind >= kMinReturned * beams;
}

}  // namespace waymark::workflows
