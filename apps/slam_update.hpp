// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "apps/localize_method.hpp"
#include "geodb/map_contents.hpp"
#include "localization/slam/ekf_slam.hpp"
namespace waymark {

/// What a drive changes in a map.
struct SlamUpdate {
  std::vector<Landmark> changed, added;
  std::vector<Observation> evidence;  ///< one for each landmark seen: the drive's word for it
  std::size_t untyped = 0;            ///< landmarks left out, since nothing says what they are
};

/// Landmarks of the map that were seen, or missed: place, covariance, existence (confidence), how often seen
/// of how often visible; features the map did not have. Its own features stay. And landmarks the map does not
/// have whose log odds reach `confirmed`, of the type they were seen as, else `beacon` or the map's only
/// type; one that said its name gets it as uid. One observation each, from `source`. Coordinates are those of
/// the map's CRS; heights are kept, and unknown for what is new.
SlamUpdate slam_update(std::span<const SlamLandmark> landmarks, const RobotMap& map,
                       const LandmarkNames& names, const std::string& source, double confirmed);

/// How SLAM runs for a task: options, start and odometry noise. Throws Error{usage} where the map has
/// landmarks and the start is not known.
struct SlamRun {
  SlamOptions options;
  PlayOptions play;
  PoseEstimate start;
};
SlamRun slam_run(const LocalizeTask& task, const SlamOptions& options);

inline constexpr double kAround = 5000;  ///< m round the start, of a map too large to be read at once

/// Plays the task's log to a localizer, with stems found in its scans.
Track play_with(const LocalizeTask& task, const SlamRun& run, Localizer& localizer);

/// Carries out --update-map or --write-map of the task; nothing where neither is asked for. `job`: JSON of
/// the method and its settings. Says what was written.
void write_back(const LocalizeTask& task, std::span<const SlamLandmark> landmarks, double confirmed,
                const std::string& job);

}  // namespace waymark
