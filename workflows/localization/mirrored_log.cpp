// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/mirrored_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <type_traits>

namespace waymark::workflows {
namespace {

using localization::Pose2;
using localization::Track;

Pose2 mirrored(const Pose2& pose) {
  return {pose.x, -pose.y, -pose.yaw};
}

void mirror(localization::TwistReading& reading, MirroredPart) {
  reading.sideways = -reading.sideways;
  reading.turn = -reading.turn;
}
void mirror(localization::CarReading& reading, MirroredPart) {
  reading.steering = -reading.steering;
}
void mirror(localization::StepReading& reading, MirroredPart) {
  reading.step = mirrored(reading.step);
}
void mirror(localization::SightingSet& set, MirroredPart part) {
  if (part == MirroredPart::robot) set.robot_from_sensor = mirrored(set.robot_from_sensor);
  for (localization::SeenLandmark& seen : set.sightings)
    if (seen.bearing) *seen.bearing = -*seen.bearing;
  set.horizon = {};
}
void mirror(localization::LaserScan& scan, MirroredPart part) {
  if (part == MirroredPart::robot) scan.robot_from_sensor = mirrored(scan.robot_from_sensor);
  if (scan.ranges.empty()) return;
  scan.first_angle = -(scan.first_angle + static_cast<double>(scan.ranges.size() - 1) * scan.angle_step);
  std::ranges::reverse(scan.ranges);
  scan.roll = -scan.roll;
}

/// How well a track fits its map.
struct Fit {
  std::int64_t sightings = 0, matched = 0, lost = 0;
  double mean_nis = 0;  // NaN: not known

  explicit Fit(const Track& track)
      : sightings(std::accumulate(track.verdicts.begin(), track.verdicts.end(), std::int64_t{0})),
        matched(track.verdicts[static_cast<std::size_t>(localization::Verdict::matched)]),
        lost(std::ranges::count(track.rows, true, &localization::TrackRow::lost)) {
    double sum = 0, rows = 0;
    for (const localization::TrackRow& row : track.rows) sum += row.nis, rows += row.nis_rows;
    mean_nis = sum / rows;
  }

  // On made streets and halls a right log matches 31 to 64 % of its sightings with the map of another drive,
  // since cars, people and doors differ. Exchanged, it matches at most 18 %, and half of what is right.
  bool is_much_better_than(const Fit& other) const {
    return 4 * matched >= sightings && matched >= 2 * other.matched && lost <= other.lost;
  }
};

}  // namespace

localization::RobotLog mirror_log(const localization::RobotLog& log, MirroredPart part) {
  localization::RobotLog other = log;
  for (localization::LogEvent& event : other.events)
    std::visit(
        [&](auto& reading) {
          using Reading = std::decay_t<decltype(reading)>;
          constexpr bool kAbsolute = std::is_same_v<Reading, localization::GnssFix> ||
                                     std::is_same_v<Reading, localization::HeadingFix>;
          constexpr bool kSensor = std::is_same_v<Reading, localization::SightingSet> ||
                                   std::is_same_v<Reading, localization::LaserScan>;
          if constexpr (!kAbsolute)
            if (kSensor ? part != MirroredPart::motion : part != MirroredPart::sensors) mirror(reading, part);
        },
        event.what);
  return other;
}

localization::RobotLog beginning_of(const localization::RobotLog& log) {
  localization::RobotLog start = log;
  int looks = 0;
  const auto end = std::ranges::find_if(start.events, [&](const localization::LogEvent& event) {
    const bool look = std::holds_alternative<localization::SightingSet>(event.what) ||
                      std::holds_alternative<localization::LaserScan>(event.what);
    return look && ++looks > 200;
  });
  start.events.erase(end, start.events.end());
  return start;
}

bool fits_badly(const Track& track) {
  const Fit fit(track);
  return fit.sightings >= 20 && (2 * fit.matched < fit.sightings || 10 * fit.lost > std::ssize(track.rows));
}

std::string mirror_warning(const Track& as_written, const Track& with_sensors, const Track& with_robot,
                           const Track& with_motion_alone) {
  const Fit written(as_written), sensors(with_sensors), robot(with_robot), motion(with_motion_alone);
  if (motion.is_much_better_than(written) && motion.matched > std::max(sensors.matched, robot.matched))
    return fmt::format(
        "the log fits the map if left and right are exchanged in its motion: {} of {} sightings are matched, "
        "as "
        "written {} of {}; turns and steps to the left are positive",
        motion.matched, motion.sightings, written.matched, written.sightings);
  const bool both = sensors.is_much_better_than(written) && robot.is_much_better_than(written);
  if (!both && !sensors.is_much_better_than(written) && !robot.is_much_better_than(written)) return {};
  const bool with_motion =
      both ? robot.mean_nis < 0.9 * sensors.mean_nis : robot.is_much_better_than(written);
  const bool unsure = both && !with_motion && !(sensors.mean_nis < 0.9 * robot.mean_nis);
  const Fit& better = with_motion ? robot : sensors;
  return fmt::format(
      "the log fits the map if left and right are exchanged in its bearings and beams{}: {} of {} sightings "
      "are matched, as written {} of {}; y and bearings are positive to the left",
      with_motion ? " and its motion"
      : unsure    ? ", and perhaps in its motion"
                  : "",
      better.matched, better.sightings, written.matched, written.sightings);
}

}  // namespace waymark::workflows
