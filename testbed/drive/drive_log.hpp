// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "testbed/drive/drive_world.hpp"
namespace waymark::testbed {

/// Coordinates of the log: metres of the map frame (the CRS itself if it is local), or the CRS in its
/// units.
struct LogCrs {
  std::string crs = "local";
  double metres_per_unit = 1;
};

/// Returns all measurements of the vehicle as a log (docs/reference/log_format.md). Sensors are sampled on
/// several threads; each reading uses a random stream of its own, so the bytes do not depend on the number of
/// threads.
std::string drive_log(const DriveWorld& world, const LogCrs& place);

/// Returns the true poses: t,x,y,z,roll,pitch,yaw and the other columns of a track
/// (docs/reference/log_format.md).
std::string true_track(const DriveWorld& world, const LogCrs& place);

/// Returns the felled trees, one row each in order of time: t,x,y,z,diameter,height,tree. `tree` is the
/// index in standing_table.
std::string felled_table(const DriveWorld& world, const LogCrs& place);
/// Returns all trees: type,x,y,z,height,diameter,crown_diameter,felled (s; empty: not felled).
std::string standing_table(const DriveWorld& world, const LogCrs& place);

}  // namespace waymark::testbed
