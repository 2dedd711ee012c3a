// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "testbed/ground.hpp"
#include "testbed/landing/crater_field.hpp"
#include "testbed/noise.hpp"
namespace waymark {

/// The terrain's nodes: the site, north-up, its middle at (east, north).
NodeGrid nodes_of(const MadeGround& ground);

/// Relief down to `shortest` metres.
Fractal relief_fractal(const MadeRelief& relief, double shortest, std::uint64_t seed);

/// Relief coarser than `finest` metres, with the site's slope and mountains.
Grid<float> coarse_relief(const MadeGround& ground, const NodeGrid& nodes, double finest, std::uint64_t seed);

/// How much of each node dunes cover, [0, 1], and how high they stand there (added to `heights`).
Grid<float> blow_dunes(Grid<float>& heights, const MadeGround& ground, const NodeGrid& nodes,
                       std::uint64_t seed);

/// Raises outcrops onto `heights` and returns how much of each node they cover.
Grid<float> raise_outcrops(Grid<float>& heights, const MadeGround& ground, const NodeGrid& nodes,
                           std::uint64_t seed);

/// Normal albedo of each node.
Grid<float> paint(const MadeGround& ground, const NodeGrid& nodes, const Grid<float>& dunes,
                  const Grid<float>& outcrops, const std::vector<CraterPlan>& craters, std::uint64_t seed);

}  // namespace waymark
