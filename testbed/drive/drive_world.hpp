// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "testbed/drive/drive.hpp"
#include "testbed/scene.hpp"
namespace waymark::testbed {

/// Tree felled during the drive, and its time.
struct FelledTree {
  double t = 0;
  std::uint32_t tree = 0;  ///< index into DriveWorld::trees
};

/// Site and true path of the vehicle: the input of all sensor models.
struct DriveWorld {
  DriveSettings settings;
  std::uint64_t seed = 0;
  std::vector<Eigen::Vector2d> path;  ///< a point every half metre
  std::vector<DriveStep> steps;
  std::string mishap;  ///< that ended the drive before its path did; empty if none
  std::vector<StandingTree> trees;
  std::vector<FelledTree> felled;  ///< in the order of time
  LaserTargets targets;
};

/// Plans the route, drives it and fells the trees along it. The scene's rocks must outlive the result.
/// Deterministic for the same settings, scene and seed. Throws Error{usage} if no path joins the waypoints.
DriveWorld make_drive(const DriveSettings& settings, const Scene& scene, std::vector<StandingTree> trees,
                      std::uint64_t seed);

/// Returns the site of a drive without path and steps: a vehicle that steers itself adds them.
DriveWorld make_drive_site(const DriveSettings& settings, const Scene& scene, std::vector<StandingTree> trees,
                           std::uint64_t seed);

/// Reads a table of real trees. Throws Error{input}.
/// - Columns: x or x_coord, y or y_coord (metres), dbh (cm) or diameter (m); optional height, stand_id,
///   year (the last of each tree_id is used).
/// - Missing heights are 1.3 + 30 (1 - exp(-0.03 dbh)) m with dbh in cm, for conifers.
/// - The centre of the trees is moved to `middle`; feet are on the terrain.
std::vector<StandingTree> trees_from_table(std::string_view csv, const std::string& source,
                                           const std::string& stand, const Eigen::Vector2d& middle,
                                           const Terrain& terrain);

}  // namespace waymark::testbed
