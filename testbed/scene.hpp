// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "geo/terrain.hpp"
#include "testbed/landing/rock_solid.hpp"
#include "testbed/site_model.hpp"
namespace waymark::testbed {

/// True rock of a scene.
struct TrueRock {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< GridFrame, centre of its outline on the ground
  double width = 0;                                    ///< metres, mean of the axes of the outline
  double height = 0;                                   ///< metres, top above the surrounding ground
  RockShape shape = RockShape::ellipsoid;
};

/// True crater of a scene. Heights and depth are measured on the finished terrain.
struct TrueCrater {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< GridFrame, centre of the rim, median rim height
  double major = 0, minor = 0;                         ///< metres, full axes of the rim crest
  double orientation = 0;      ///< of the major axis, radians clockwise from north, (-pi/2, pi/2]
  double depth = 0;            ///< metres, median rim crest to floor
  double formation_depth = 0;  ///< metres, before younger craters, dunes and relief
  double age = 0;              ///< diffusion age kappa t / radius^2: 0 fresh, 0.3 almost erased

  double diameter() const { return std::sqrt(major * minor); }
  /// Returns the preserved fraction of the depth. Craters below kErased are ignored in evaluation.
  double preserved_fraction() const { return formation_depth > 0 ? depth / formation_depth : 0; }
};
inline constexpr double kErased = 0.4;

/// Synthetic planetary site with its truth. Copies share the terrain.
struct Scene {
  SiteModel ground;
  std::uint64_t seed = 0;
  Terrain terrain;
  Grid<float> albedo;               ///< at the terrain's nodes
  std::vector<RockSolid> solids;    ///< solids[i] is rocks[i]
  std::vector<TrueRock> rocks;      ///< widest first
  std::vector<TrueCrater> craters;  ///< widest first, including erased ones
};

/// Generates a scene. Deterministic for the same parameters and seed, bit for bit, for any number of
/// threads. Throws Error{usage} for invalid sizes and above 1e9 nodes. About 1 s per 4 M nodes on one core.
Scene make_scene(const SiteModel& ground, std::uint64_t seed);

}  // namespace waymark::testbed
