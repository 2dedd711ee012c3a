// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "testbed/drive/drive.hpp"
#include "testbed/scene.hpp"
namespace waymark {

/// A tree felled on the way, and when.
struct FelledTree {
  double t = 0;
  std::uint32_t tree = 0;  ///< index into DriveWorld::trees
};

/// A site with the vehicle's true way over it: all that sensors need.
struct DriveWorld {
  DriveSettings settings;
  std::uint64_t seed = 0;
  std::vector<Eigen::Vector2d> way;  ///< a point every half metre
  std::vector<DriveStep> steps;
  std::vector<StandingTree> trees;
  std::vector<FelledTree> felled;  ///< in the order of time
  LaserTargets targets;
};

/// Plans the route, drives it and fells the trees along it. The scene's rocks must outlive the result. The
/// same for the same settings, scene and seed. Throws Error{usage} where no way leads between waypoints.
DriveWorld make_drive(const DriveSettings& settings, const Scene& scene, std::vector<StandingTree> trees,
                      std::uint64_t seed);

/// A table of real trees: columns x or x_coord, y or y_coord (metres), dbh (cm) or diameter (m), optionally
/// height (m; else 1.3 + 30 (1 - exp(-0.03 dbh)), a form for conifers, cm), stand_id, year (the last of each
/// tree_id). Their middle is moved to `middle`; feet stand on the terrain. Throws Error{input}.
std::vector<StandingTree> trees_from_table(std::string_view csv, const std::string& source,
                                           const std::string& stand, const Eigen::Vector2d& middle,
                                           const Terrain& terrain);

}  // namespace waymark
