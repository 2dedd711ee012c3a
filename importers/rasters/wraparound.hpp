// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/georeference.hpp"
namespace waymark::importers {

/// Marks a grid as wrapping if its columns cover all longitudes, in degrees or in a cylindrical projection.
/// Drops the columns that repeat the first ones, and marks the poles it reaches (outermost row within one
/// cell of +-90 degrees). Leaves other grids unchanged.
void mark_wraparound(GridGeometry& grid);

}  // namespace waymark::importers
