// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "geo/terrain.hpp"
#include "testbed/ground.hpp"
#include "testbed/landing/rock_solid.hpp"
namespace waymark {

/// A rock as the truth list tells it.
struct TrueRock {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< GridFrame, middle of its outline on the ground
  double width = 0;                                    ///< metres, mean of the outline's axes
  double height = 0;                                   ///< metres, top above the ground around it
  RockShape shape = RockShape::ellipsoid;
};

/// A crater as the truth list tells it. Heights and depth are measured on the finished ground.
struct TrueCrater {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< GridFrame, middle of the rim, median rim height
  double major = 0, minor = 0;                         ///< metres, full axes of the rim crest
  double orientation = 0;  ///< of the major axis, radians clockwise from north, (-pi/2, pi/2]
  double depth = 0;        ///< metres, median rim crest to floor
  double made_depth = 0;   ///< metres, before younger craters, dunes and relief
  double age = 0;          ///< diffusion kappa t / radius^2: 0 fresh, 0.3 all but gone

  double diameter() const { return std::sqrt(major * minor); }
  /// How much of it is still there. Below kErased a detector is neither blamed nor praised for it.
  double preserved() const { return made_depth > 0 ? depth / made_depth : 0; }
};
inline constexpr double kErased = 0.4;

/// A made piece of planet with everything known about it. Copies share the terrain.
struct Scene {
  MadeGround ground;
  std::uint64_t seed = 0;
  Terrain terrain;
  Grid<float> albedo;               ///< at the terrain's nodes
  std::vector<RockSolid> solids;    ///< solids[i] is rocks[i]
  std::vector<TrueRock> rocks;      ///< widest first
  std::vector<TrueCrater> craters;  ///< widest first; the erased ones too
};

/// The same scene for the same ground and seed, bit for bit, whatever the number of threads.
/// Throws Error{usage} for sizes that make no sense and above 1e9 nodes. About 1 s per 4 M nodes on one core.
Scene make_scene(const MadeGround& ground, std::uint64_t seed);

}  // namespace waymark
