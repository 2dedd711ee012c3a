// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include "importers/rasters/raster_header.hpp"
namespace waymark::importers {

/// Returns the memory for decoded blocks of a DEM, bytes: `asked`, or the automatic choice for 0.
/// - A DEM that fits into 512 MB is kept, since isolation reads it once more.
/// - A larger one is read tile by tile, for which 96 MB are as good as more; where a file is stored in
///   strips, as many as one row of tiles touches, up to 512 MB.
std::int64_t dem_memory(std::int64_t asked, std::span<const RasterHeader> headers);

}  // namespace waymark::importers
