// SPDX-License-Identifier: Apache-2.0
#include "localization/frame_errors.hpp"

namespace waymark::localization {

void FrameErrors::describe(OptionVisitor& option) {
  option("map_shift_sd", map_shift_sd,
         {.help = "Standard deviation, metres, of a shift that neighbouring landmarks share; negative: of "
                  "imported maps the part of the stated accuracy that sightings do not show, of others none",
          .min = -1,
          .max = 1000});
  option("map_shift_distance", map_shift_distance,
         {.help = "Metres driven until the shift of the map has fallen to 1/e", .min = 1, .max = 1e6});
  option("mount_sd", mount_sd,
         {.help = "Standard deviation, metres, of the sensors' place on the robot, forward and left",
          .min = 0,
          .max = 10});
  option("mount_yaw_sd", mount_yaw_sd,
         {.help = "Standard deviation, radians, of the sensors' direction on the robot", .min = 0, .max = 1});
}

}  // namespace waymark::localization
