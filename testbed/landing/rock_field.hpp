// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/random.hpp"
#include "testbed/landing/crater_field.hpp"
#include "testbed/scene.hpp"
namespace waymark::testbed {

/// Returns the number of rocks wider than `diameter` per square metre (the integral of dF / (pi D^2 / 4) up
/// to the largest).
double rocks_per_area(const RockPopulation& law, double diameter);

/// Generates a rock of this width and height, its outline centred at its own origin; `foot` is not set. The
/// area of its outline at ground level is pi width^2 / 4 and its top is `height`, both to 1 %.
RockSolid make_rock(RockShape shape, double width, double height, Random& random);

struct RockField {
  std::vector<RockSolid> solids;
  std::vector<TrueRock> rocks;
};
/// Places rocks on the terrain, widest first, without overlapping outlines. Dunes (cover of each node, [0,
/// 1]) bury nine tenths of the rocks under them.
RockField scatter_rocks(const SiteModel& ground, const Terrain& terrain, const Grid<float>& dunes,
                        const std::vector<CraterPlan>& craters, std::uint64_t seed);

}  // namespace waymark::testbed
