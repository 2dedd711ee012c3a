// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/georeference.hpp"
namespace waymark {

/// Where the columns go all the way round the body, in degrees or in a cylindrical projection: drops the
/// columns that repeat the first ones, marks the grid as one that wraps, and marks the poles it reaches
/// (outermost row within one cell of +-90 degrees). Other grids stay as they are.
void close_the_circle(GridGeometry& grid);

}  // namespace waymark
