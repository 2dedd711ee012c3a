// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "core/options.hpp"
#include "core/units.hpp"
#include "localization/laser_scan.hpp"
#include "testbed/drive/ray_fan.hpp"
namespace waymark {

/// A line scanner. Each beam is a fan of rays as wide as its divergence; what returns is the first thing that
/// catches enough of it, so that edges are hit early and stems look wider than they are.
struct LaserModel {
  bool on = true;
  double every = 2;          ///< s between two scans
  Degrees field{240};        ///< from the first beam to the last
  Degrees step{0.25};        ///< between beams
  double most_range = 30;    ///< metres
  Degrees divergence{0.2};   ///< full width of a beam
  std::int64_t rays = 5;     ///< per beam across its width; 1: a line
  double sensitivity = 0.3;  ///< share of a beam that must meet a thing for it to be seen
  double range_bias = 0;     ///< metres
  double range_sd = 0.02;    ///< metres
  double dropouts = 0.01;    ///< share of beams that return nothing
  double clutter = 0.001;    ///< share of beams that return a range from nowhere (dust, insects)
  double mixed = 0.3;        ///< share of beams on an edge that return a range between both things
  bool levelled = true;      ///< held level; false: it tilts with the vehicle
  Degrees tilt_sd{0.2};      ///< error of the roll and pitch that the log tells
  bool perfect = false;      ///< no divergence, noise, dropouts, clutter

  std::int64_t beams() const;
  LaserModel without_errors() const;
};
void describe_laser(LaserModel& laser, OptionVisitor& field);

/// One sweep in the plane of x and y of the sensor; z up. `grid_from_sensor`: rotation only is used, the rays
/// come from the fan's origin.
LaserScan sweep(const RayFan& fan, const Eigen::Matrix3d& grid_from_sensor, const LaserModel& laser,
                Random& random);

}  // namespace waymark
