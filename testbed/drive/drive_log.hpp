// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "testbed/drive/drive_world.hpp"
namespace waymark {

/// Where positions of the log are: metres of the map frame, which in a local CRS is the CRS itself, or the
/// CRS, in its units.
struct LogPlace {
  std::string crs = "local";
  double metres_per_unit = 1;
};

/// Everything the vehicle measured, as a log of docs/log_format.md. Sensors are sampled on several threads;
/// each reading draws from a stream of its own, so the bytes do not depend on their number.
std::string drive_log(const DriveWorld& world, const LogPlace& place);

/// Where it truly was: t,x,y,z,roll,pitch,yaw and the other columns of a track (docs/localization.md).
std::string true_track(const DriveWorld& world, const LogPlace& place);

/// Felled trees: t,x,y,z,diameter,height,tree; one row each, in the order of time. `tree` is the index in
/// standing_table.
std::string felled_table(const DriveWorld& world, const LogPlace& place);
/// All trees: type,x,y,z,height,diameter,crown_diameter,felled (s; empty: stays).
std::string standing_table(const DriveWorld& world, const LogPlace& place);

}  // namespace waymark
