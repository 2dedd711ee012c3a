// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "localization/motion_model.hpp"
#include "localization/odometry_drift.hpp"
#include "testbed/drive/drive_world.hpp"
namespace waymark::testbed {

struct OdometryErrors {
  localization::OdometryNoise noise;
  localization::OdometryDrift drift;
};

/// Returns what the maker of the vehicle knows of its odometry on such ground: the errors of the model. Slip
/// and sideways drift are those for the root mean square of pitch and roll over the poses of `steps` (none:
/// level ground). The mean slip counts as unknown, as part of `scale_sd`.
OdometryErrors odometry_errors(const DriveSettings& settings, std::span<const DriveStep> steps);

}  // namespace waymark::testbed
