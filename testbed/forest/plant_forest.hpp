// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "geo/terrain.hpp"
#include "testbed/forest/forest_law.hpp"
namespace waymark {

/// A made forest with everything known about it.
struct MadeForest {
  std::vector<MadeStand> stands;
  std::vector<StandingTree> trees;  ///< tallest first; understory too
};

/// Plants the forest about (east, north). Stems by the pattern of the law, thinned to its clearance: poisson
/// (a Matern hard-core process), clustered (Thomas process), rows (a jittered lattice). Diameters by a
/// Weibull law, heights and crowns by the species. The understory stands anywhere. The same forest for the
/// same law, terrain and seed, bit for bit. Throws Error{usage} for sizes that make no sense and above 4
/// million trees. Trees where the terrain is unknown are left out.
MadeForest plant_forest(const ForestLaw& law, const Terrain& terrain, double east, double north,
                        std::uint64_t seed);

/// Stand that holds a place; -1 outside all.
int stand_at(const std::vector<MadeStand>& stands, const Eigen::Vector2d& place);

}  // namespace waymark
