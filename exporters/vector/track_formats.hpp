// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>
#include "localization/track.hpp"
namespace waymark::exporters {

/// Formats of tracks that evaluation tools and optimizers read.
/// - tum: `t x y z qx qy qz qw` per row (TUM RGB-D)
/// - kitti: the upper three rows of the 4 x 4 pose per row, without time
/// - g2o: VERTEX_SE2, and EDGE_PRIOR_SE2 with the inverse covariance where the covariance is known
enum class TrackFormat { tum, kitti, g2o };

/// Writes the poses of a track, in the map frame: metres, map_from_robot. Staged and renamed. Throws
/// Error{output}.
void write_track_poses(const std::filesystem::path& file, const localization::Track& track,
                       TrackFormat format);

/// Returns whether a file begins with a number or a comment, as TUM does, and not with names of columns.
bool begins_like_tum(std::string_view content);

/// Returns the poses of a file of TUM; covariances are 0. `file` is for messages. Throws Error{input} with
/// the line for other than eight numbers and for quaternions that are not of length 1.
localization::Track read_track_tum(std::string_view content, const std::filesystem::path& file);

}  // namespace waymark::exporters
