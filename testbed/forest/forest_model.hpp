// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "testbed/forest/forest.hpp"
namespace waymark::testbed {

/// Allometry and crown shape of a species. Height (Chapman-Richards): H = 1.3 + top (1 - exp(-rate
/// D))^bend, D in centimetres. Crown diameter: CD = crown_intercept + crown_slope D, D in metres.
struct SpeciesModel {
  std::string name;
  bool conifer = true;
  double top = 34, rate = 0.045, bend = 1.3;
  double height_scatter = 0.07;  ///< relative standard deviation of a height at its diameter
  double crown_intercept = 1.2, crown_slope = 11;
  double crown_scatter = 0.12;  ///< relative standard deviation of a crown's diameter
  double crown_length = 0.6;    ///< crown length as a fraction of the height
  /// Crown surface: height above its base = length (1 - (r / R)^shape); 1 a cone, 2 a paraboloid.
  double shape = 1.2;
  double lobes = 0.08;  ///< relative sd of the outline's radius over direction
  double depth = 0.25;  ///< mean penetration of a pulse into the crown, metres
};

/// Parameters of a synthetic forest and of its laser scan.
struct ForestModel {
  bool on = false;                   ///< whether the scenario has a section `forest`
  double width = 120, height = 120;  ///< metres
  double density = 500;              ///< stems per hectare from 7 cm DBH, first stand
  double density_to = 0;             ///< last stand, geometric in between; 0: as the first
  std::int64_t stands = 1;           ///< strips from west to east, with irregular borders
  std::string pattern = "poisson";   ///< poisson, clustered, rows
  double clearance = 0.9;            ///< minimum stem distance, metres
  double cluster_radius = 4;         ///< metres, clustered
  double cluster_size = 6;           ///< mean trees per cluster
  double row_jitter = 0.3;           ///< metres, sd of a planted tree about its lattice point
  double conifers = 0.7;             ///< fraction of the stems
  double mean_dbh = 0.26;     ///< metres, Weibull mean of the first stand; the others by Reineke's rule
  double dbh_shape = 2.3;     ///< Weibull shape: 1 uneven-aged, 4 a plantation
  double understory = 100;    ///< trees per hectare below 7 cm DBH
  double cell = 0.5;          ///< metres, of the rasters
  double pulses = 8;          ///< per square metre
  double range_sd = 0.03;     ///< metres, of a return's height
  double position_sd = 0.10;  ///< metres, of a return's horizontal position
  double dtm_sd = 0.10;       ///< metres, correlated error of the terrain model
  bool points = true;         ///< write the point cloud

  /// Returns two species, a conifer and a broadleaf.
  const std::vector<SpeciesModel>& species() const;
};

/// Stand of a synthetic forest: its outline, counter-clockwise and open, metres, GridFrame.
struct SyntheticStand {
  std::string name;
  std::vector<Eigen::Vector2d> outline;
  double density = 0;  ///< nominal, stems per hectare
};

inline constexpr double kMinDbh = 0.07;  ///< metres; trees below are understory

}  // namespace waymark::testbed
