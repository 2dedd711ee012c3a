// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/grid.hpp"
#include "geo/dem_source.hpp"
#include "importers/rasters/mosaic.hpp"
namespace waymark::importers {

/// Reads the heights of a window with voids interpolated as by gdal_fillnodata: inverse distance to the
/// nearest height in each of four quadrants, at most `distance` cells away, no smoothing, rounded if the
/// files hold whole metres.
/// - A cell has the same height in every window that contains it.
/// - Cells outside the grid and voids farther than `distance` cells from data stay empty.
/// - The voids of a window are read with a margin of `distance` cells; those without data there cost no more.
HeightWindow read_filled(const Mosaic& mosaic, const Window& window, int distance);

}  // namespace waymark::importers
