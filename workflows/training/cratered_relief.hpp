// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "pipeline/craters/relief_scene.hpp"
namespace waymark::workflows {

/// Reads "DEM,CATALOGUE": a DEM and a table with columns lon, lat (degrees), diameter and depth (metres) of
/// all craters in it. Holds the whole DEM, 4 bytes a cell. Throws Error{usage} if the comma is missing,
/// Error{input} for files or columns that cannot be used. So it does for cells that are not about square at
/// the equator, and a DEM too small for a scene of `side` pixels.
pipeline::CrateredRelief read_cratered_relief(const std::string& dem_and_catalogue, int side);

}  // namespace waymark::workflows
