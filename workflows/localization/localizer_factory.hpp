// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include "localization/global/constellation.hpp"
#include "localization/global/pose_finder.hpp"
#include "localization/global/skyline.hpp"
#include "localization/slam/ekf_slam.hpp"
#include "workflows/localization/localize_method.hpp"
namespace waymark::workflows {

/// Options of global localization: how a lost robot is found in the map.
struct SearchOptions {
  localization::ConstellationOptions constellations;
  localization::SkylineOptions skyline;
  void describe(OptionVisitor& option) {
    constellations.describe(option);
    skyline.describe(option);
  }
};

/// Returns a finder of poses by constellations of landmarks in the whole map, and with a DEM by skylines. The
/// map is read at the first call.
localization::PoseFinder make_pose_finder(const LocalizeTask& task, const SearchOptions& search);

/// Lets SLAM check its pose, and relocalize, by that finder, if the map has landmarks.
void enable_relocalization(localization::EkfSlam& slam, const LocalizeTask& task,
                           const SearchOptions& search);

/// Returns a particle filter that relocalizes with that finder. Without a start it begins with global
/// localization. Moves the landmark window out of the task.
std::unique_ptr<localization::Localizer> make_particle_localizer(
    LocalizeTask& task, const std::optional<localization::PoseEstimate>& start, const SearchOptions& search);

/// Returns an extended or unscented Kalman filter that relocalizes with that finder; without identities a sum
/// of Gaussians. Moves the landmark window out of the task.
std::unique_ptr<localization::Localizer> make_kalman_localizer(LocalizeTask& task,
                                                               const SearchOptions& search, bool unscented);

/// Returns the visibility over the DEM; everything is visible without one.
localization::LineOfSight line_of_sight(const LocalizeTask& task);

}  // namespace waymark::workflows
