// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>
#include "core/grid.hpp"
#include "testbed/ground.hpp"
#include "testbed/noise.hpp"
#include "testbed/scene.hpp"
namespace waymark {

/// A crater to be made.
struct CraterPlan {
  double east = 0, north = 0;   ///< GridFrame
  double major = 1, minor = 1;  ///< metres, full axes of the rim crest
  double turn = 0;              ///< of the major axis, radians from east towards north
  double age = 0;               ///< kappa t / radius^2
  double infill = 0;            ///< share of the depth that sand has filled, flat
  std::uint32_t seed = 0;       ///< of its rim's irregularity

  double diameter() const { return std::sqrt(major * minor); }
};

/// Craters of the site, oldest first in time. Some lie beyond its edges and reach in.
std::vector<CraterPlan> draw_craters(const MadeGround& ground, std::uint64_t seed);

/// Digs the crater: the ground inside its rim is first levelled to the plane through its surroundings, as an
/// impact does, then bowl, rim and ejecta are added.
void dig(Grid<float>& heights, const NodeGrid& nodes, const CraterPlan& crater);

/// The truth about a crater on the finished ground; median rim of 36 azimuths, floor: 10th percentile within
/// 0.4 of the radius. Nothing where its rim leaves the ground.
std::optional<TrueCrater> measure(const Terrain& terrain, const CraterPlan& crater);

}  // namespace waymark
