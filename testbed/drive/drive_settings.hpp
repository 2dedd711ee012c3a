// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>
#include "core/options.hpp"
#include "core/units.hpp"
#include "testbed/drive/laser_scanner.hpp"
#include "testbed/drive/laser_targets.hpp"
#include "testbed/drive/panorama.hpp"
#include "testbed/drive/rover_body.hpp"
#include "testbed/drive/stereo_camera.hpp"
namespace waymark {

/// What goes wrong between the wheels and the ground, and in what odometry tells of it.
struct OdometryModel {
  double rate = 5;              ///< readings per second
  double slip = 0.03;           ///< share of the wheels' way that is lost on level ground
  double slip_per_slope = 0.4;  ///< more share lost per metre risen per metre
  double slip_sd = 0.02;        ///< of the share lost, wavering over some metres
  double side_slip = 0.15;      ///< sideways speed per speed and sine of the roll
  double scale_sd = 0.01;       ///< of the wheels' size, one draw per drive
  double speed_sd = 0.01;       ///< noise of a speed, share of it
  Degrees yaw_bias_sd{0.01};    ///< per second, of the gyro, one draw per drive
  Degrees yaw_sd{0.15};         ///< noise of the yaw per square root of a metre
  bool perfect = false;
};

/// Satellite positions, as the harvester has them under the canopy.
struct GnssModel {
  bool on = false;
  double every = 1;       ///< s
  double sd = 2;          ///< metres, each coordinate, of single fixes
  double bias_sd = 3;     ///< metres, wandering
  double bias_time = 60;  ///< s over which the bias changes
  double dropouts = 0.3;  ///< share of fixes missed
  bool perfect = false;
};

/// A crane that fells trees and says where they stood.
struct CraneModel {
  double reach = 10;       ///< metres
  double corridor = 2.2;   ///< metres to each side of the route: all trees are felled
  double thinning = 0.25;  ///< share of the other trees within reach that are felled
  double range_sd = 0.1;   ///< metres
  Degrees bearing_sd{0.5};
  double diameter_sd = 0.005;  ///< metres, of the harvester head
  double height_sd = 0.3;      ///< metres
};

struct DriveSettings {
  bool on = false;                         ///< whether the scenario has a drive
  std::string vehicle = "rover";           ///< or harvester
  std::string route = "wander";            ///< waypoints, loop, lanes, wander
  std::vector<Eigen::Vector2d> waypoints;  ///< metres from the middle of the site
  double length = 200;                     ///< metres, of an automatic route
  double lane_spacing = 20;                ///< metres
  double margin = 15;                      ///< metres kept from the edge of the ground
  double speed = 0.5;                      ///< m/s
  double clearance = 1.3;                  ///< metres between the vehicle's middle and rocks
  double steepest = 0.45;                  ///< metres per metre
  double start_sd = 0.1;                   ///< metres, error of the start the log tells
  Degrees start_yaw_sd{1};
  std::int64_t seed = -1;  ///< -1: the scenario's; another seed, another drive on the same site
  bool truth_in_log = true;
  Wheels wheels;
  OdometryModel odometry;
  LaserModel laser;
  double laser_height = 0;  ///< metres above the ground; 0: rover 0.35, harvester 2
  StereoModel stereo;
  BearingModel camera;
  PanoramaModel panorama;
  GnssModel gnss;
  ForestClutter clutter;
  CraneModel crane;
  std::string trees;  ///< table of real trees instead of the forest of the scenario
  std::string stand;  ///< rows of the table with this stand_id only

  bool harvester() const { return vehicle == "harvester"; }
};

/// A part of the section `drive`; the empty name: its own fields.
struct DrivePart {
  std::string name, help;
  void (*describe)(DriveSettings&, OptionVisitor&);
};
const std::vector<DrivePart>& drive_parts();

}  // namespace waymark
