// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/slam/graph.hpp"
namespace waymark {

/// Checks that every index is one, every number finite, and that every pose and landmark is tied to the first
/// pose, directly or over others. Throws Error{input} naming the first id that is not, or std::out_of_range.
void check_connected(const PoseGraph& graph);

/// Place of a landmark by one sighting; nothing for a bearing.
std::optional<Eigen::Vector2d> place_seen(const SightingEdge& edge, const Pose2& pose);

/// The order in which poses can be placed one after another, each by an edge to one before: the lowest index
/// first. Poses tied to the rest by landmarks only come in the order in which two of theirs are known.
struct Placement {
  std::size_t pose = 0;
  std::optional<std::size_t> by_step = {};  ///< index of the edge that places it; nothing: by landmarks
};
std::vector<Placement> placing_order(const PoseGraph& graph);

/// Pose from which the landmarks placed so far were seen as these sightings say: least squares over at least
/// two (Horn 1987 in the plane); nothing for fewer.
std::optional<Pose2> pose_by_landmarks(const PoseGraph& graph, const std::vector<std::size_t>& sightings,
                                       const std::vector<bool>& placed);

/// Where two rays cross (each from its place along its yaw), if they do so at more than 6 degrees and ahead.
std::optional<Eigen::Vector2d> crossing_of(const Pose2& a, const Pose2& b);

}  // namespace waymark
