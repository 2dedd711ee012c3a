// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "geo/terrain.hpp"
#include "testbed/forest/forest_model.hpp"
namespace waymark::testbed {

/// Synthetic forest with its truth.
struct SyntheticForest {
  std::vector<SyntheticStand> stands;
  std::vector<StandingTree> trees;  ///< tallest first; understory too
};

/// Generates a forest about (east, north). Deterministic for the same parameters, terrain and seed, bit for
/// bit.
/// - Stem patterns, thinned to the clearance: poisson (Matern hard-core process), clustered (Thomas
///   process), rows (jittered lattice).
/// - Diameters are Weibull distributed; heights and crowns follow the species. Understory is placed
///   anywhere.
/// - Trees on unknown terrain are left out.
/// Throws Error{usage} for invalid sizes and above 4 million trees.
SyntheticForest plant_forest(const ForestModel& law, const Terrain& terrain, double east, double north,
                             std::uint64_t seed);

/// Returns the index of the stand that contains a position; -1 if none does.
int stand_index_at(const std::vector<SyntheticStand>& stands, const Eigen::Vector2d& place);

}  // namespace waymark::testbed
