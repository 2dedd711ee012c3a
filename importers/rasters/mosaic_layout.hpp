// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/grid.hpp"
#include "importers/rasters/raster_header.hpp"
namespace waymark::importers {

/// One grid for several files.
struct MosaicLayout {
  GridGeometry grid;
  std::vector<Window>
      files;  ///< where each file lies in the grid; may reach past the last column of a grid that wraps
};

/// Places the files on the grid of the first one. Files across the antimeridian are shifted by whole turns. A
/// grid that covers all longitudes wraps, and repeated columns are dropped.
/// - Throws Error if CRS, cell size or alignment differ by more than 1/1000 of a cell. It names both files,
///   the numbers and the gdalwarp command that corrects them.
MosaicLayout lay_out(const std::vector<RasterHeader>& headers);

}  // namespace waymark::importers
