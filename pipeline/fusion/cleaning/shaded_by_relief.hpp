// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>
#include "geo/sun.hpp"
#include "geo/terrain.hpp"
namespace waymark::pipeline {

/// A rock, as its shadow suggests it.
struct SupposedRock {
  Eigen::Vector2d foot;  ///< metres
  double radius = 0;     ///< metres
  double height = 0;     ///< metres
};

/// What a terrain shows where a rock is supposed.
struct ReliefAtRock {
  double light = 1;  ///< mean over the supposed shadow, relative to the terrain around it; 0 is full shadow
  double stands_out = 0;  ///< height above the highest terrain around, in heights of the rock
};

/// Computes light by cosine of incidence and cast shadows, with normals over two cells.
/// `std::nullopt` below one cell of diameter or if a height is unknown. `towards_light` is a unit vector
/// above the horizon. About 70 rays.
std::optional<ReliefAtRock> measure_relief(const Terrain& terrain, const SupposedRock& rock,
                                           const Eigen::Vector3d& towards_light);

struct ReliefRules {
  double min_cells = 2;  ///< smallest diameter of a rock, in cells of the terrain, that its relief can refute
  double min_drop = 0.3;  ///< smallest loss of light that refutes a rock; 1: none is refuted
  double drop_sds = 3;    ///< the same, in standard deviations of the light at all rocks
  /// Smallest part of its height by which a rock stands out of a terrain of fine cells. Those that do are not
  /// refuted: their own body casts the shadow.
  double min_stands_out = 0.35;
  std::size_t min_count = 20;  ///< fewest rocks that show the standard deviation
};

/// Returns for each rock whether the terrain explains its shadow: it is dark there without it, and no body
/// stands there. The error of the light is that of the brighter half of all rocks, since false ones are dark.
std::vector<char> explained_by_relief(const Terrain& terrain, std::span<const SupposedRock> rocks,
                                      const Eigen::Vector3d& towards_light, const ReliefRules& rules = {});

}  // namespace waymark::pipeline
