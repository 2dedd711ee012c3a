// SPDX-License-Identifier: Apache-2.0
#include "exporters/view/view_drive.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace waymark::exporters {
namespace {

/// Returns indices 0 .. count - 1, at most `max_count` of them, evenly spread, with the first and the last.
std::vector<std::size_t> thinned(std::size_t count, std::size_t max_count) {
  std::vector<std::size_t> kept;
  const std::size_t shown = std::min(count, max_count);
  for (std::size_t i = 0; i < shown; ++i) kept.push_back(shown < 2 ? 0 : i * (count - 1) / (shown - 1));
  return kept;
}

ViewPose view_pose(double t, const localization::Pose2& pose, const ViewFrame& frame) {
  const Eigen::Vector3d at = frame.from_map_frame({pose.x, pose.y, 0});
  return {.t = t,
          .x = static_cast<float>(at.x()),
          .y = static_cast<float>(at.y()),
          .yaw = static_cast<float>(pose.yaw)};
}

ViewScan view_laser(double t, const localization::LaserScan& scan, std::size_t max_rays) {
  ViewScan view{.t = t, .is_laser = true, .rays = {}};
  view.mount = Eigen::Vector2d(scan.robot_from_sensor.x, scan.robot_from_sensor.y).cast<float>();
  for (const std::size_t i : thinned(scan.ranges.size(), max_rays)) {
    const double range = scan.ranges[i];
    if (!(range > 0 && range < scan.max_range)) continue;
    const double bearing =
        scan.robot_from_sensor.yaw + scan.first_angle + static_cast<double>(i) * scan.angle_step;
    view.rays.push_back({static_cast<float>(bearing), static_cast<float>(range)});
  }
  return view;
}

ViewScan view_sightings(double t, const localization::SightingSet& seen, std::size_t max_rays) {
  ViewScan view{.t = t, .is_laser = false, .rays = {}};
  view.mount = Eigen::Vector2d(seen.robot_from_sensor.x, seen.robot_from_sensor.y).cast<float>();
  for (const localization::SeenLandmark& one : seen.sightings)
    if (one.range && *one.range > 0 && std::isfinite(*one.range) && one.bearing &&
        std::isfinite(*one.bearing) && view.rays.size() < max_rays)
      view.rays.push_back(
          {static_cast<float>(seen.robot_from_sensor.yaw + *one.bearing), static_cast<float>(*one.range)});
  return view;
}

}  // namespace

ViewTrack make_view_track(const std::string& name, const localization::Track& track, const ViewFrame& frame,
                          const DriveBudget& budget) {
  ViewTrack view{.name = name, .is_truth = false, .poses = {}};
  for (const std::size_t i : thinned(track.rows.size(), budget.poses)) {
    const localization::TrackRow& row = track.rows[i];
    if (!row.at.pose.at().allFinite() || !std::isfinite(row.at.pose.yaw)) continue;
    ViewPose pose = view_pose(row.t, row.at.pose, frame);
    const Eigen::Matrix3d& c = row.at.covariance;
    if (c.topLeftCorner<2, 2>().allFinite()) {
      pose.var_x = static_cast<float>(c(0, 0));
      pose.var_y = static_cast<float>(c(1, 1));
      pose.cov_xy = static_cast<float>(c(0, 1));
    }
    pose.lost = row.lost;
    view.poses.push_back(pose);
  }
  return view;
}

ViewTrack make_view_truth(const std::vector<localization::StampedPose>& truth, const ViewFrame& frame,
                          const DriveBudget& budget) {
  ViewTrack view{.name = "truth", .is_truth = true, .poses = {}};
  for (const std::size_t i : thinned(truth.size(), budget.poses))
    view.poses.push_back(view_pose(truth[i].t, truth[i].pose, frame));
  return view;
}

std::vector<ViewScan> make_view_scans(const localization::RobotLog& log, const DriveBudget& budget) {
  std::vector<const localization::LogEvent*> measured;
  for (const localization::LogEvent& event : log.events)
    if (std::holds_alternative<localization::LaserScan>(event.what) ||
        std::holds_alternative<localization::SightingSet>(event.what))
      measured.push_back(&event);
  std::vector<ViewScan> scans;
  for (const std::size_t i : thinned(measured.size(), budget.scans)) {
    const localization::LogEvent& event = *measured[i];
    const auto* laser = std::get_if<localization::LaserScan>(&event.what);
    ViewScan scan =
        laser != nullptr
            ? view_laser(event.t, *laser, budget.rays)
            : view_sightings(event.t, std::get<localization::SightingSet>(event.what), budget.rays);
    if (!scan.rays.empty()) scans.push_back(std::move(scan));
  }
  return scans;
}

}  // namespace waymark::exporters
