// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/random.hpp"
#include "testbed/landing/crater_field.hpp"
#include "testbed/scene.hpp"
namespace waymark {

/// Rocks wider than `diameter` per square metre under the law (the integral of dF / (pi D^2 / 4) up to the
/// largest).
double rocks_per_area(const RockLaw& law, double diameter);

/// One rock of this width and height with its outline's middle at the origin of its own axes; `foot` is not
/// yet set. The area of its outline at ground level is pi width^2 / 4 and its top is `height`, both to 1 %.
RockSolid make_rock(RockShape shape, double width, double height, Random& random);

struct RockField {
  std::vector<RockSolid> solids;
  std::vector<TrueRock> rocks;
};
/// Rocks on the ground, widest first, none within another's outline. Dunes (cover of each node, [0, 1]) have
/// buried nine tenths of theirs.
RockField strew_rocks(const MadeGround& ground, const Terrain& terrain, const Grid<float>& dunes,
                      const std::vector<CraterPlan>& craters, std::uint64_t seed);

}  // namespace waymark
