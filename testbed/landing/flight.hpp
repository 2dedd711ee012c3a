// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "testbed/scenario.hpp"
namespace waymark::testbed {

/// Image to be taken.
struct Shot {
  std::string name;                       ///< file name
  PosedCamera view;                       ///< true pose, with the covariance of the reported pose
  CameraMotion motion = {};               ///< while the shutter is open; zero along lines
  std::optional<double> time = {};        ///< s from the start of a landing
  DustCloud dust = {};                    ///< below a lander
  FallingShield shield = {};              ///< below a lander
  Pose<GridFrame, CameraFrame> reported;  ///< reported pose, with the errors of the scenario
};

/// Returns every image of every flight, in the order of the file.
std::vector<Shot> plan_shots(const Scenario& scenario);

/// Returns what a camera sees of a shot: its pose, motion, dust and heat shield.
View view_of(const Shot& shot);

/// Returns the true camera of a shot, with its motion if rows are read out one after the other.
PosedCamera true_camera(const Shot& shot, double readout_time);

/// Returns the site with width and height filled in where they are 0: the footprints of all images on level
/// ground at its mean height, plus a tenth. Throws Error{usage} for a camera that sees the sky.
SiteModel size_site(const Scenario& scenario, const std::vector<Shot>& shots);

/// Throws Error{usage} naming the first image that extends beyond the terrain, with what to change.
void check_footprints(const Scene& scene, const std::vector<Shot>& shots);

}  // namespace waymark::testbed
