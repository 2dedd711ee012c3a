// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include "geo/dem_source.hpp"
#include "workflows/mapping/move_map.hpp"
namespace waymark::workflows {

/// Returns a DEM moved into the CRS `crs`: a north-up grid about it with its cell size, heights bilinear,
/// kNoHeight where one of four is unknown. Reads by windows. The DEM is in metres, not in degrees.
std::shared_ptr<const DemSource> moved_dem(std::shared_ptr<const DemSource> dem, const MapMove& move,
                                           const Crs& crs);

}  // namespace waymark::workflows
