// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/grid.hpp"
#include "geo/dem_source.hpp"
#include "importers/rasters/mosaic.hpp"
namespace waymark {

/// The heights of a window, its voids interpolated as gdal_fillnodata does: inverse distance to the nearest
/// height in each of four quadrants, at most 100 cells away, no smoothing, rounded where the files hold whole
/// metres. Exact: the same cells come out whatever the window. Cells outside the grid and voids wider than
/// 200 cells stay empty. A window with voids is read with 100 cells around it.
HeightWindow read_filled(const Mosaic& mosaic, const Window& window);

}  // namespace waymark
