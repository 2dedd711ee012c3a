// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/options.hpp"
namespace waymark::localization {

/// Standard deviations of the errors that separate the pose relative to landmarks from the robot's position
/// in the reference frame: a shift that neighbouring landmarks share, and the place of the sensors on the
/// robot.
struct FrameErrors {
  double map_shift_sd = -1;         ///< m, of each coordinate; negative: as accurate as the map states
  double map_shift_distance = 100;  ///< m driven until the shift has fallen to 1/e
  double mount_sd = 0;              ///< m, forward and left, of all sensors alike, constant
  double mount_yaw_sd = 0;          ///< rad, of all sensors alike, constant

  void describe(OptionVisitor& option);
  bool any() const { return map_shift_sd > 0 || mount_sd > 0 || mount_yaw_sd > 0; }
};

}  // namespace waymark::localization
