// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include "geo/similarity.hpp"
#include "pipeline/reconstruction/adjustment/observations.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

/// Frame of true size whose position and direction are conventional.
struct FrameByHeights {
  Similarity local_from_frame = {};
  std::size_t readings = 0;  ///< that give the scale
  double scale_sd = 0;       ///< as a fraction of the scale
};

struct FrameByHeightsResult {
  std::optional<FrameByHeights> found = {};
  std::string message = {};  ///< why there is none
};

/// Gives a component a frame by heights alone: level by the upward directions, else by the plane of the tie
/// points; the scale by the median ratio of the heights above ground, else by the slope of the other heights
/// over those of the cameras. The ground below the first image by name has the height 0 (with other heights:
/// theirs), and the upper edge of that image points north. Refused for fewer than 2 heights, and if the scale
/// has a deviation of more than 5 %.
FrameByHeightsResult frame_by_heights(const Reconstruction& scene, const Observations& seen,
                                      std::size_t component);

}  // namespace waymark::pipeline
