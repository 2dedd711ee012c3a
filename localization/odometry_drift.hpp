// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/options.hpp"
namespace waymark::localization {

/// Standard deviations of odometry errors that persist; 0: none. Independent errors are OdometryNoise.
struct OdometryDrift {
  double scale_sd = 0;         ///< of the distance driven, relative, constant: wheel radius, mean slip
  double slip_sd = 0;          ///< of the distance driven, relative, correlated over `drift_distance`
  double sideways_sd = 0;      ///< m sideways per metre driven, correlated over `drift_distance`
  double drift_distance = 10;  ///< m until slip and sideways drift have fallen to 1/e
  double yaw_rate_sd = 0;      ///< rad/s, constant: bias of the gyro
  double curvature_sd = 0;     ///< rad of yaw per metre driven, constant: wheels of unequal diameter

  void describe(OptionVisitor& option);
  bool any() const {
    return scale_sd > 0 || slip_sd > 0 || sideways_sd > 0 || yaw_rate_sd > 0 || curvature_sd > 0;
  }
  bool operator==(const OdometryDrift&) const = default;
};

}  // namespace waymark::localization
