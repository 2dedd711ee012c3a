// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/options.hpp"
namespace waymark::localization {

/// Standard deviations of the errors that separate the pose relative to landmarks from the robot's position
/// in the reference frame: a shift that neighbouring landmarks share, and the place of the sensors on the
/// robot.
struct FrameErrors {
  double map_shift_sd = -1;          ///< m, of each coordinate; negative: what sightings leave of `survey_sd`
  double map_shift_distance = 1000;  ///< m driven until the shift has fallen to 1/e
  double mount_sd = 0;               ///< m, forward and left, of all sensors alike, constant
  double mount_yaw_sd = 0;           ///< rad, of all sensors alike, constant

  double survey_sd = 0;  ///< m: accuracy of a landmark that an imported map states; no option

  void describe(OptionVisitor& option);
  /// Returns whether the sightings decide which part of `survey_sd` is a shift (IndependentFraction).
  bool shift_is_learnt() const { return map_shift_sd < 0 && survey_sd > 0; }
  bool any() const { return map_shift_sd > 0 || shift_is_learnt() || mount_sd > 0 || mount_yaw_sd > 0; }
};

}  // namespace waymark::localization
