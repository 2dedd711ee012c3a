// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>
#include "core/options.hpp"
#include "core/units.hpp"
#include "localization/terrain_pose.hpp"
#include "testbed/drive/laser_scanner.hpp"
#include "testbed/drive/laser_targets.hpp"
#include "testbed/drive/panorama.hpp"
#include "testbed/drive/scanner_model.hpp"
#include "testbed/drive/stereo_camera.hpp"
#include "testbed/dynamics/soil.hpp"
namespace waymark::testbed {

/// Wheel slip and odometry errors.
struct OdometryModel {
  double rate = 5;              ///< readings per second
  double slip = 0.03;           ///< fraction of the wheel distance lost on level ground
  double slip_per_slope = 0.4;  ///< additional fraction lost per unit of slope
  double slip_sd = 0.02;        ///< of the fraction lost, correlated over some metres
  double side_slip = 0.15;      ///< sideways speed per speed and sine of the roll
  double scale_sd = 0.01;       ///< of the wheel radius, drawn once per drive
  double speed_sd = 0.01;       ///< noise of a speed, relative
  Degrees yaw_bias_sd{0.01};    ///< per second, gyro bias, drawn once per drive
  Degrees yaw_sd{0.15};         ///< noise of the yaw per square root of a metre
  bool perfect = false;
};

/// GNSS positions of a harvester under canopy.
struct GnssModel {
  bool on = false;
  double every = 1;       ///< s
  double sd = 2;          ///< metres, each coordinate, noise of single fixes
  double bias_sd = 3;     ///< metres, correlated error
  double bias_time = 60;  ///< s, correlation time of the bias
  double dropouts = 0.3;  ///< fraction of fixes missing
  bool perfect = false;
};

/// Harvester crane that fells trees and reports their stem positions.
struct CraneModel {
  double reach = 10;       ///< metres
  double corridor = 2.2;   ///< metres to each side of the route where all trees are felled
  double thinning = 0.25;  ///< fraction of the other trees within reach that are felled
  double range_sd = 0.1;   ///< metres
  Degrees bearing_sd{0.5};
  double diameter_sd = 0.005;  ///< metres, of the harvester head
  double height_sd = 0.3;      ///< metres
};

/// How a vehicle follows a planned route by its own estimate of the pose.
struct NavigationModel {
  std::string map;             ///< relative to the scenario, as `hazards`
  std::string method = "ekf";  ///< of `waymark localize`; identities are unknown
  std::string sensor = "horizontal_laser";
  std::string hazards = "none";   ///< made by `waymark hazards`
  std::string dem;                ///< terrain that hides landmarks; empty: that stored in the map, or none
  std::string vehicle = "rover";  ///< of `waymark vehicles`, or a file
  double limit_sigma = 0;         ///< metres, of the position; 0: none
  double sd_factor = 1.5;         ///< tolerated ratio of the estimated sd to the planned one
  double cell = 2;                ///< metres, of the search for another route
  double margin = 0.2;            ///< metres between the vehicle and an obstacle
  std::int64_t replans = 30;      ///< most new routes before the vehicle gives up; 0: the route as it is
  bool avoid = true;              ///< avoid obstacles that its own sensors see
};

/// Rigid body on wheels (testbed/dynamics) instead of a vehicle that stands on the plane under its wheels.
struct DynamicsModel {
  bool on = false;
  std::string vehicle;    ///< of `waymark vehicles`, or a file; empty: that of the drive
  double gravity = 3.71;  ///< m/s^2
  Soil soil;
};

struct DriveSettings {
  bool on = false;                         ///< whether the scenario has a drive
  std::string vehicle = "rover";           ///< or harvester
  std::string route = "wander";            ///< waypoints, loop, lanes, wander, or a file of a planned route
  std::vector<Eigen::Vector2d> waypoints;  ///< metres from the middle of the site
  double length = 200;                     ///< metres, of an automatic route
  double lane_spacing = 20;                ///< metres
  double margin = 15;                      ///< minimum distance to the edge of the terrain, metres
  double speed = 0.5;                      ///< m/s
  double clearance = 1.3;   ///< minimum distance between the vehicle's centre and rocks, metres
  double max_slope = 0.45;  ///< maximum slope, metres per metre
  double start_sd = 0.1;    ///< metres, error of the start position in the log
  Degrees start_yaw_sd{1};
  std::int64_t seed = -1;  ///< -1: seed of the scenario; another seed gives another drive on the same site
  bool truth_in_log = true;
  localization::Wheels wheels{.base = 1.6, .track = 1.4};
  OdometryModel odometry;
  LaserModel laser;
  double laser_height = 0;  ///< metres above the ground; 0: rover 0.35, harvester 2
  ScannerModel scanner;
  StereoModel stereo;
  BearingModel camera;
  PanoramaModel panorama;
  GnssModel gnss;
  ForestClutter clutter;
  CraneModel crane;
  NavigationModel navigation;
  DynamicsModel dynamics;
  std::string trees;  ///< table of real trees; replaces the forest of the scenario
  std::string stand;  ///< use only rows of the table with this stand_id

  bool harvester() const { return vehicle == "harvester"; }
  /// Returns the name or file of the vehicle that moves with `dynamics`.
  const std::string& moved_vehicle() const { return dynamics.vehicle.empty() ? vehicle : dynamics.vehicle; }
  /// Returns whether the route is a file.
  bool planned() const { return route.find('.') != std::string::npos; }
};

/// Part of the section `drive`; an empty name denotes its own fields.
struct DrivePart {
  std::string name, help;
  void (*describe)(DriveSettings&, OptionVisitor&);
};
const std::vector<DrivePart>& drive_parts();

}  // namespace waymark::testbed
