// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "testbed/scenario.hpp"
namespace waymark {

/// One image to be taken.
struct Shot {
  std::string name;                   ///< file name
  PosedCamera view;                   ///< true pose; the covariance is that of the pose told
  Pose<GridFrame, CameraFrame> told;  ///< with the errors of the scenario
};

/// Every image of every flight, in the order of the file.
std::vector<Shot> plan_shots(const Scenario& scenario);

/// The site with width and height filled in where they are 0: all footprints on level ground at its mean
/// height and a tenth more. Throws Error{usage} for a camera that sees the sky.
MadeGround sized_for(const Scenario& scenario, const std::vector<Shot>& shots);

/// Throws Error{usage} naming the first image that looks past the terrain, with what to change.
void check_footprints(const Scene& scene, const std::vector<Shot>& shots);

}  // namespace waymark
