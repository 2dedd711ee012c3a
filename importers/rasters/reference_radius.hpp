// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "importers/rasters/raster_header.hpp"
class GDALDataset;
namespace waymark::importers {

/// Radius to subtract from distances to the body's centre to get elevations.
struct ReferenceRadius {
  double metres = 0;   ///< the equatorial radius of the CRS's body; 0: the heights are elevations already
  std::string reason;  ///< the evidence, with numbers
};

/// Detects shape maps of planetary archives, whose heights are distances from the body's centre (PDS3: values
/// plus OFFSET = 1737400). The evidence is a band offset within 1 km of the equatorial radius, or heights of
/// the first non-empty block within 5 % of it. Reads blocks only if the numbers of the band can reach that
/// far.
ReferenceRadius detect_reference_radius(GDALDataset& dataset, const RasterHeader& header);

}  // namespace waymark::importers
