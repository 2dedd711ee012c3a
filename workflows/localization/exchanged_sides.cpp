// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/exchanged_sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/replay_log.hpp"

namespace waymark::workflows {
namespace {

using localization::LaserScan;
using localization::Pose2;
using localization::SightingSet;
using Points = std::vector<Eigen::Vector2d>;  // m, in the frame of the sensor or robot

constexpr std::int64_t kMaxLooks = 200, kMinPoints = 100, kMinCells = 10;
constexpr double kMinStep = 0.2, kMinTurn = 0.1;     // m and rad between two looks
constexpr double kMaxRange = 15;                     // m; farther points move by errors of heading
constexpr double kBeamCell = 0.25, kObjectCell = 1;  // m
constexpr std::size_t kMaxBeams = 200;               // of a scan
// Where robots turn, exchanged scans of made halls and of the Intel lab fill 1.6 to 5 times as many cells.
constexpr double kMaxRatio = 0.75;

/// The points that a look shows, as written and with left and right exchanged.
struct Look {
  Pose2 robot_from_sensor;
  Points written, exchanged;
};

void add(Look& look, double range, double bearing, double max_range) {
  if (!(range > 0 && range < std::min(max_range, kMaxRange))) return;
  const Eigen::Vector2d point{range * std::cos(bearing), range * std::sin(bearing)};
  look.written.push_back(point);
  look.exchanged.emplace_back(point.x(), -point.y());
}

Look look_of(const LaserScan& scan) {
  Look look{scan.robot_from_sensor, {}, {}};
  const std::size_t step = 1 + scan.ranges.size() / kMaxBeams;
  for (std::size_t i = 0; i < scan.ranges.size(); i += step)
    add(look, scan.ranges[i], scan.first_angle + static_cast<double>(i) * scan.angle_step, scan.max_range);
  return look;
}

Look look_of(const SightingSet& set) {
  Look look{set.robot_from_sensor, {}, {}};
  for (const localization::SeenLandmark& seen : set.sightings)
    if (seen.range && seen.bearing) add(look, *seen.range, *seen.bearing, kMaxRange);
  return look;
}

bool has_scans(const localization::RobotLog& log) {
  return std::ranges::any_of(log.events, [](const localization::LogEvent& event) {
    return std::holds_alternative<LaserScan>(event.what);
  });
}

/// Distinct cells of a grid.
class Cells {
 public:
  explicit Cells(double size) : size_(size) {}
  void add(const Pose2& from_sensor, const Points& points) {
    const double cosine = std::cos(from_sensor.yaw), sine = std::sin(from_sensor.yaw);
    for (const Eigen::Vector2d& p : points)
      all_.emplace_back(std::floor((from_sensor.x + cosine * p.x() - sine * p.y()) / size_),
                        std::floor((from_sensor.y + sine * p.x() + cosine * p.y()) / size_));
  }
  std::int64_t count() {
    std::ranges::sort(all_);
    return std::unique(all_.begin(), all_.end()) - all_.begin();
  }

 private:
  double size_;
  std::vector<std::pair<double, double>> all_;
};

bool is_elsewhere(const Pose2& pose, const Pose2& last) {
  return std::hypot(pose.x - last.x, pose.y - last.y) >= kMinStep ||
         std::abs(std::remainder(pose.yaw - last.yaw, 2 * M_PI)) >= kMinTurn;
}

}  // namespace

bool SeenCells::fit_exchanged() const {
  return points >= kMinPoints && as_written >= kMinCells &&
         static_cast<double>(exchanged) < kMaxRatio * static_cast<double>(as_written);
}

SeenCells count_seen_cells(const localization::RobotLog& log,
                           std::span<const localization::StampedPose> poses) {
  const bool scans = has_scans(log);
  Cells written(scans ? kBeamCell : kObjectCell), exchanged = written;
  SeenCells seen;
  std::optional<Pose2> last;
  for (const localization::LogEvent& event : log.events) {
    if (seen.looks == kMaxLooks) break;
    const auto* scan = std::get_if<LaserScan>(&event.what);
    const auto* set = std::get_if<SightingSet>(&event.what);
    if (scans ? !scan : !set) continue;
    const auto pose = pose_at(poses, event.t);
    if (!pose || (last && !is_elsewhere(*pose, *last))) continue;
    const Look look = scan ? look_of(*scan) : look_of(*set);
    if (look.written.empty()) continue;
    last = pose;
    written.add(*pose * look.robot_from_sensor, look.written);
    exchanged.add(*pose * look.robot_from_sensor, look.exchanged);
    ++seen.looks, seen.points += std::ssize(look.written);
  }
  seen.as_written = written.count(), seen.exchanged = exchanged.count();
  return seen;
}

std::vector<localization::StampedPose> poses_by_odometry(const localization::RobotLog& log) {
  localization::DeadReckoning none({});
  localization::LogReplay replay(log, none, {});
  std::vector<localization::StampedPose> poses;
  for (const localization::LogEvent& event : log.events) {
    replay.take(event);
    replay.forget_rows();
    if (std::holds_alternative<LaserScan>(event.what) || std::holds_alternative<SightingSet>(event.what))
      poses.push_back({event.t, replay.dead_reckoning()});
  }
  return poses;
}

std::string exchanged_sides_warning(const localization::RobotLog& log,
                                    std::span<const localization::StampedPose> poses,
                                    const std::string& source) {
  const SeenCells seen = count_seen_cells(log, poses);
  if (!seen.fit_exchanged()) return {};
  return fmt::format(
      "the {} fit {} if left and right are exchanged in them: the first {} then show {} cells of the ground, "
      "as written {}; y, bearings and turns are positive to the left",
      has_scans(log) ? "scans" : "sightings", source, seen.looks, seen.exchanged, seen.as_written);
}

}  // namespace waymark::workflows
