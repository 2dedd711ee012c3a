// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>
#include "geo/similarity.hpp"
namespace waymark::pipeline {

/// Position known in the frame of a reconstruction and in the map.
struct PositionPair {
  Eigen::Vector3d frame = Eigen::Vector3d::Zero(), map = Eigen::Vector3d::Zero();
  double sd = 1;  ///< of the difference, metres of the map
};

/// Similarity with the pairs that agree with it.
struct RobustSimilarity {
  Similarity map_from_frame = {};
  std::vector<bool> agrees = {};  ///< by pair: within 3 standard deviations
  double score = 0;               ///< sum of squared residuals over sd, at most 9 each
};

/// Returns the similarity that most pairs agree with: the best of all triples by the score (MSAC, Torr &
/// Zisserman 2000), then least squares over the pairs that agree. From 40 pairs, every n-th triple is tried.
/// `std::nullopt` if fewer than three pairs agree, or if these lie on one line up to their deviations.
std::optional<RobustSimilarity> robust_similarity(const std::vector<PositionPair>& pairs);

/// Returns the same, given the upward direction in the frame, from two pairs that differ in plan. The map's z
/// points up.
std::optional<RobustSimilarity> robust_similarity(const std::vector<PositionPair>& pairs,
                                                  const Eigen::Vector3d& up_in_frame);

/// Returns the root mean square distance of the map positions from their best line.
double distance_from_line(const std::vector<PositionPair>& pairs);

}  // namespace waymark::pipeline
