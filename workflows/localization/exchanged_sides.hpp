// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>
#include "localization/robot_log.hpp"
namespace waymark::workflows {

/// Cells of the ground that the beginning of a drive sees: few if its looks fit its poses, since a wall that
/// is seen twice is then in the same cells.
struct SeenCells {
  std::int64_t looks = 0, points = 0;
  std::int64_t as_written = 0, exchanged = 0;  ///< cells; with left and right of each look exchanged

  /// Returns whether the exchanged looks fit the poses far better. A drive without turns fits both alike.
  bool fit_exchanged() const;
};

/// Counts the cells of up to 200 looks, 0.2 m or 0.1 rad apart, from places that `poses` has. A look is a
/// scan, or a set of sightings where the log has no scans; points farther than 15 m are left out.
SeenCells count_seen_cells(const localization::RobotLog& log,
                           std::span<const localization::StampedPose> poses);

/// Returns the poses of the looks by odometry alone, in the frame of the first.
std::vector<localization::StampedPose> poses_by_odometry(const localization::RobotLog& log);

/// Returns a warning if the looks fit the poses far better with left and right exchanged; empty otherwise.
/// `source` names the poses, "the odometry" for instance.
std::string exchanged_sides_warning(const localization::RobotLog& log,
                                    std::span<const localization::StampedPose> poses,
                                    const std::string& source);

}  // namespace waymark::workflows
