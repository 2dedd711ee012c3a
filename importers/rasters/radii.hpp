// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "importers/rasters/raster_header.hpp"
class GDALDataset;
namespace waymark {

/// What makes elevations of distances from the body's centre.
struct RadiusTakenOff {
  double metres = 0;    ///< the equatorial radius of the CRS's body; 0: the heights are elevations already
  std::string because;  ///< how it was seen, with numbers
};

/// Planetary archives also publish shape maps, whose heights are distances from the body's centre: in PDS3,
/// values plus OFFSET = 1737400. They are known by an offset of the band within 1 km of the body's equatorial
/// radius, or by heights within 5 % of it: those of the first block that has any. Blocks are read only where
/// the numbers of the band reach that far.
RadiusTakenOff radius_to_take_off(GDALDataset& dataset, const RasterHeader& header);

}  // namespace waymark
