// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
namespace waymark::localization {

/// Elevation of the horizon by direction, of a full turn or a part.
struct HorizonProfile {
  double first_angle = 0, angle_step = 0;  ///< rad, left of forward
  double elevation_sd = 0.001;             ///< rad
  std::vector<float> elevations;           ///< rad; not finite: unknown
};

}  // namespace waymark::localization
