// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geodb/map_store.hpp"
#include "workflows/mapping/register_map.hpp"
namespace waymark::workflows {

/// Returns the place of a map in a DEM, by the heights of `request.dem`, else those of the map's elevation
/// tiles (`pipeline::register_heights`).
/// Throws Error{input} for a place that is not certain or a map without heights.
MapPlace register_by_heights(const RegisterRequest& request, const geodb::MapStore& map);

}  // namespace waymark::workflows
