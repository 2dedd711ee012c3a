// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include "core/options.hpp"
#include "core/units.hpp"
#include "localization/laser_scan.hpp"
#include "testbed/drive/ray_fan.hpp"
namespace waymark::testbed {

/// Line scanner. Each beam is a fan of rays as wide as its divergence; it returns from the first object
/// that intercepts enough of it. Edges are therefore hit early, and stems appear too wide.
struct LaserModel {
  bool on = true;
  double every = 2;          ///< s between two scans
  Degrees field{240};        ///< from the first beam to the last
  Degrees step{0.25};        ///< between beams
  double max_range = 30;     ///< metres
  Degrees divergence{0.2};   ///< full width of a beam
  std::int64_t rays = 5;     ///< per beam across its width; 1: a line
  double sensitivity = 0.3;  ///< minimum fraction of a beam that an object must intercept
  double range_bias = 0;     ///< metres
  double range_sd = 0.02;    ///< metres
  double dropouts = 0.01;    ///< fraction of beams without return
  double clutter = 0.001;    ///< fraction of beams with a false range (dust, insects)
  double mixed = 0.3;        ///< fraction of beams on an edge that return a range between both objects
  bool levelled = true;      ///< levelled mount; false: tilts with the vehicle
  Degrees tilt_sd{0.2};      ///< error of the roll and pitch in the log
  bool perfect = false;      ///< no divergence, noise, dropouts, clutter

  std::int64_t beams() const;
  LaserModel ideal_model() const;
};
void describe_laser(LaserModel& laser, OptionVisitor& field);

/// Returns the range of the first hit along a unit vector; `std::nullopt` if nothing is hit.
using RayCast = std::function<std::optional<double>(const Eigen::Vector3d& along)>;

/// Simulates one sweep in the x-y plane of the sensor; z up. Only the rotation of `grid_from_sensor` is
/// used; rays start at the origin of the fan.
localization::LaserScan sweep(const RayCast& cast, const Eigen::Matrix3d& grid_from_sensor,
                              const LaserModel& laser, Random& random);
localization::LaserScan sweep(const RayFan& fan, const Eigen::Matrix3d& grid_from_sensor,
                              const LaserModel& laser, Random& random);

}  // namespace waymark::testbed
