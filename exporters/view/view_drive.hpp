// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "exporters/view/view_frame.hpp"
#include "exporters/view/view_scene.hpp"
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark::exporters {

/// Most poses of a track and most scans and rays of a log in a page.
struct DriveBudget {
  std::size_t poses = 4000, scans = 900, rays = 160;
};

/// Returns an estimated track, thinned evenly to the budget; the last pose is kept.
ViewTrack make_view_track(const std::string& name, const localization::Track& track, const ViewFrame& frame,
                          const DriveBudget& budget = {});
/// Returns true poses as a track without covariance.
ViewTrack make_view_truth(const std::vector<localization::StampedPose>& truth, const ViewFrame& frame,
                          const DriveBudget& budget = {});
/// Returns laser scans and sightings with ranges, thinned evenly to the budget. Beams without return are left
/// out.
std::vector<ViewScan> make_view_scans(const localization::RobotLog& log, const DriveBudget& budget = {});

}  // namespace waymark::exporters
