// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string_view>
#include "geodb/map_contents.hpp"
#include "localization/slam/ekf_slam.hpp"
#include "workflows/localization/localize_method.hpp"
namespace waymark::workflows {

/// Changes that a drive makes to a map.
struct SlamUpdate {
  std::vector<Landmark> changed, added;
  std::vector<Observation> evidence;  ///< one per observed landmark
  std::size_t untyped = 0;            ///< landmarks left out because their type is unknown
};

/// Returns the changes that a drive makes to its map, in the map's CRS.
/// - Landmarks of the map that were observed or missed: position, covariance, existence (confidence), counts
///   of seen and visible (one survey), and features (one observation, eq. 3). Heights of the map stay.
/// - New landmarks whose log odds reach `confirmed`, of the observed type, else `beacon` or the map's only
///   type. A landmark with an identity gets it as uid; heights are unknown.
/// - One observation per observed landmark, from `source`.
SlamUpdate make_slam_update(std::span<const localization::SlamLandmark> landmarks, const RobotMap& map,
                            const localization::LandmarkNames& names, const std::string& source,
                            double confirmed);

/// Options, start and odometry noise of SLAM for a task.
struct SlamSetup {
  localization::SlamOptions options;
  localization::ReplayOptions play;
  localization::PoseEstimate start;
};
/// Throws Error{usage} if the map has landmarks and the start is unknown.
SlamSetup slam_setup(const LocalizeTask& task, const localization::SlamOptions& options);

/// Leaves out the fixes of a log, and warns, if the start is unknown: the frame of the map that begins here
/// is then not that of the fixes.
void leave_out_fixes_without_start(const LocalizeTask& task, localization::ReplayOptions& play);

inline constexpr double kSlamRadius = 5000;  ///< m around the start, in a map too large to be read at once

/// Returns the detectors for the laser scans of a log where the map has no landmarks that decide: those of
/// walls if straight walls return enough of the beams, else that of rocks. `std::nullopt`: those of the map.
std::optional<localization::ScanDetectionOptions> scans_of_log(const localization::RobotLog& log,
                                                               const RobotMap& map);

/// Plays the task's log to a SLAM localizer, with the landmarks found in its scans.
localization::Track run_slam(const LocalizeTask& task, const SlamSetup& setup,
                             localization::Localizer& localizer);

/// Warns of ranges without bearing that SLAM left out.
void warn_of_unplaced_ranges(const LocalizeTask& task, std::size_t count);

/// Carries out the task's `update_map` or `write_map`, if any, and sends a summary. The record of the run has
/// the method, the log and all settings.
void write_updated_map(const LocalizeTask& task, std::span<const localization::SlamLandmark> landmarks,
                       double confirmed, std::string_view method);

}  // namespace waymark::workflows
