// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/detection.hpp"
#include "workflows/training/rock_scene.hpp"
namespace waymark::workflows {

/// Assignment of detections to rocks: greedy, the largest rock first, nearest free detection within
/// max(0.75 D, 2 px). Rocks whose outline or shadow reaches the border, and detections as near to it, count
/// neither way.
struct RockMatch {
  std::vector<int> detection_of;                    ///< of each rock; -1: missed
  std::vector<int> rock_of;                         ///< of each detection; -1: none
  std::vector<char> rock_counts, detection_counts;  ///< false: too near to the border
};

/// Matches the detections in an image whose light comes from `sun_angle`, radians. O(rocks x detections).
RockMatch match_rocks(const RockImage& image, const std::vector<Detection>& found, double sun_angle);

}  // namespace waymark::workflows
