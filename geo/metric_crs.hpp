// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "geo/georeference.hpp"
namespace waymark::inline geo {

/// Returns a CRS in metres that fits the middle of a grid in degrees, as gdalwarp -t_srs accepts it.
/// - Earth: the UTM zone ("EPSG:32632"), beyond 84 N and 80 S the polar stereographic CRS of UPS.
/// - Other bodies: a transverse Mercator or polar stereographic PROJ string, in single quotes.
std::string fitting_metric_crs(const GridGeometry& grid);

}  // namespace waymark::inline geo
