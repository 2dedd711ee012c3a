// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>
#include "core/grid.hpp"
#include "testbed/noise.hpp"
#include "testbed/scene.hpp"
#include "testbed/site_model.hpp"
namespace waymark::testbed {

/// Crater to be generated.
struct CraterPlan {
  double east = 0, north = 0;   ///< GridFrame
  double major = 1, minor = 1;  ///< metres, full axes of the rim crest
  double turn = 0;              ///< of the major axis, radians from east towards north
  double age = 0;               ///< kappa t / radius^2
  double infill = 0;            ///< fraction of the depth filled with sand, flat
  std::uint32_t seed = 0;       ///< of its rim's irregularity

  double diameter() const { return std::sqrt(major * minor); }
};

/// Draws the craters of the site, oldest first. Some lie beyond its edges and reach in.
std::vector<CraterPlan> draw_craters(const SiteModel& ground, std::uint64_t seed);

/// Excavates the crater: the terrain inside its rim is first levelled to the plane through its
/// surroundings, as an impact does; then bowl, rim and ejecta are added.
void excavate(Grid<float>& heights, const NodeGrid& nodes, const CraterPlan& crater);

/// Measures a crater on the finished terrain: median rim over 36 azimuths; floor: 10th percentile within
/// 0.4 radii. `std::nullopt` if its rim leaves the terrain.
std::optional<TrueCrater> measure_crater(const Terrain& terrain, const CraterPlan& crater);

}  // namespace waymark::testbed
