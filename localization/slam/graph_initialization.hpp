// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/slam/graph.hpp"
namespace waymark::localization {

/// Checks that every index is valid, every number finite, and every pose and landmark connected to the
/// first pose. Throws Error{input} naming the first id that is not, or std::out_of_range.
void check_connected(const PoseGraph& graph);

/// Returns the position of a landmark by one sighting; `std::nullopt` for a bearing, a
/// range or a line.
std::optional<Eigen::Vector2d> landmark_position(const SightingEdge& edge, const Pose2& pose);

/// Returns the two numbers of a line by one sighting of it.
Eigen::Vector2d line_state(const SightingEdge& edge, const Pose2& pose, const SlamLine& line);

/// A pose to initialise, and the edge that does so.
struct InitializationStep {
  std::size_t pose = 0;
  std::optional<std::size_t> by_step = {};  ///< index of the edge; absent: by landmarks
};
/// Returns the order in which poses can be initialised, each by an edge to an earlier one, the lowest index
/// first. Poses connected by landmarks only come when two of their landmarks are known.
std::vector<InitializationStep> initialization_order(const PoseGraph& graph);

/// Returns the pose from which the known landmarks were seen: least squares over at least two sightings
/// (Horn 1987 in the plane). `std::nullopt` for fewer.
std::optional<Pose2> resect_pose(const PoseGraph& graph, const std::vector<std::size_t>& sightings,
                                 const std::vector<bool>& placed);

/// Returns the intersection of two rays, each from a position along its yaw. `std::nullopt` if they cross
/// at less than 6 degrees or behind a position.
std::optional<Eigen::Vector2d> intersect_rays(const Pose2& a, const Pose2& b);

}  // namespace waymark::localization
