// SPDX-License-Identifier: Apache-2.0
#include "localization/odometry_drift.hpp"

namespace waymark::localization {

void OdometryDrift::describe(OptionVisitor& option) {
  option("scale_sd", scale_sd,
         {.help = "Standard deviation of the relative error of distances that lasts the drive",
          .min = 0,
          .max = 0.5});
  option("slip_sd", slip_sd,
         {.help = "Standard deviation of the relative error of distances that lasts drift_distance",
          .min = 0,
          .max = 0.5});
  option("sideways_sd", sideways_sd,
         {.help = "Standard deviation of metres sideways per metre driven, lasting drift_distance",
          .min = 0,
          .max = 0.5});
  option("drift_distance", drift_distance,
         {.help = "Metres driven until slip and sideways drift have fallen to 1/e", .min = 0.1, .max = 1e6});
  option("yaw_rate_sd", yaw_rate_sd,
         {.help = "Standard deviation of the bias of the turn rate, rad/s, that lasts the drive",
          .min = 0,
          .max = 0.5});
  option("curvature_sd", curvature_sd,
         {.help = "Standard deviation of yaw per metre driven, rad/m, that lasts the drive",
          .min = 0,
          .max = 0.5});
}

}  // namespace waymark::localization
