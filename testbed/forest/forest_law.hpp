// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "testbed/forest/forest.hpp"
namespace waymark {

/// How the trees of a species grow. Heights by Chapman and Richards: H = 1.3 + top (1 - exp(-rate D))^bend, D
/// in centimetres; crown diameters CD = crown_least + crown_share D, D in metres.
struct SpeciesLaw {
  std::string name;
  bool conifer = true;
  double top = 34, rate = 0.045, bend = 1.3;
  double height_scatter = 0.07;  ///< relative standard deviation of a height at its diameter
  double crown_least = 1.2, crown_share = 11;
  double crown_scatter = 0.12;  ///< relative standard deviation of a crown's diameter
  double crown_length = 0.6;    ///< share of the height
  /// Surface of the crown: height above its base = length (1 - (r / R)^shape): 1 a cone, 2 a paraboloid.
  double shape = 1.2;
  double lobes = 0.08;  ///< relative sd of the outline's radius over direction
  double depth = 0.25;  ///< metres a pulse goes into the crown before it returns, mean
};

/// A made forest: how many trees of what size stand where, and how a laser sees them.
struct ForestLaw {
  bool on = false;                   ///< the scenario has a section `forest`
  double width = 120, height = 120;  ///< metres
  double density = 500;              ///< stems per hectare from 7 cm dbh, of the first stand
  double density_to = 0;             ///< of the last stand, by equal ratios between; 0: as the first
  std::int64_t stands = 1;           ///< strips of stands, west to east, with uneven borders
  std::string pattern = "poisson";   ///< poisson, clustered, rows
  double clearance = 0.9;            ///< no two stems are nearer, metres
  double cluster_radius = 4;         ///< metres, clustered
  double cluster_size = 6;           ///< mean trees per cluster
  double row_jitter = 0.3;           ///< metres a planted tree stands off its place, sd
  double conifers = 0.7;             ///< share of the stems
  double mean_dbh = 0.26;   ///< metres, of the Weibull law of the first stand; Reineke's rule for the others
  double dbh_shape = 2.3;   ///< 1 uneven-aged, 4 a plantation
  double understory = 100;  ///< trees per hectare below 7 cm dbh
  double cell = 0.5;        ///< metres, of the rasters
  double pulses = 8;        ///< per square metre
  double range_sd = 0.03;   ///< metres, of a return's height
  double place_sd = 0.10;   ///< metres, of a return's place
  double dtm_sd = 0.10;     ///< metres, smooth error of the terrain model
  bool points = true;       ///< write the point cloud

  /// Two species, a conifer and a broadleaf.
  const std::vector<SpeciesLaw>& species() const;
};

/// A stand of the made forest: its outline, counter-clockwise and open, metres, GridFrame.
struct MadeStand {
  std::string name;
  std::vector<Eigen::Vector2d> outline;
  double density = 0;  ///< asked for, stems per hectare
};

inline constexpr double kLeastDbh = 0.07;  ///< metres; thinner trees are understory

}  // namespace waymark
