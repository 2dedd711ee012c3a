// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "testbed/landing/crater_field.hpp"
#include "testbed/noise.hpp"
#include "testbed/site_model.hpp"
namespace waymark::testbed {

/// Returns the nodes of the terrain: north-up, centred at (east, north).
NodeGrid nodes_of(const SiteModel& ground);

/// Returns the fractal relief down to `shortest` metres.
Fractal relief_fractal(const ReliefModel& relief, double shortest, std::uint64_t seed);

/// Returns relief coarser than `finest` metres, with the slope and the mountains of the site.
Grid<float> coarse_relief(const SiteModel& ground, const NodeGrid& nodes, double finest, std::uint64_t seed);

/// Adds dunes to `heights` and returns the fraction of each node that they cover, [0, 1].
Grid<float> add_dunes(Grid<float>& heights, const SiteModel& ground, const NodeGrid& nodes,
                      std::uint64_t seed);

/// Adds outcrops to `heights` and returns the fraction of each node that they cover.
Grid<float> add_outcrops(Grid<float>& heights, const SiteModel& ground, const NodeGrid& nodes,
                         std::uint64_t seed);

/// Returns the normal albedo of each node.
Grid<float> paint_albedo(const SiteModel& ground, const NodeGrid& nodes, const Grid<float>& dunes,
                         const Grid<float>& outcrops, const std::vector<CraterPlan>& craters,
                         std::uint64_t seed);

}  // namespace waymark::testbed
