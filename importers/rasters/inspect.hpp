// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "importers/rasters/mosaic.hpp"
namespace waymark::importers {

/// Checks the cells for faults that a header cannot show. Throws Error for a file whose last block is damaged
/// (truncation) and for a DEM without any height. Warns of a DEM of one height, a block layout that exceeds
/// the memory limit, and seams where files disagree by over 1 mm.
std::vector<std::string> inspect(const Mosaic& mosaic, std::size_t cache_bytes);

}  // namespace waymark::importers
