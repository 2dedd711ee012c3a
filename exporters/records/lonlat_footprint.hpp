// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "geo/body.hpp"
#include "geo/crs.hpp"
namespace waymark::exporters {

/// Rectangle in the units of a CRS.
struct MapBox {
  double min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  friend bool operator==(const MapBox&, const MapBox&) = default;
};

/// Area on a body in degrees, as GeoJSON (RFC 7946) wants it: longitudes in [-180, 180], closed rings against
/// the clock, divided at the antimeridian. A ring that surrounds a pole covers all longitudes up to that
/// pole.
struct LonLatFootprint {
  std::vector<std::vector<LonLat>> rings = {};      ///< one or two
  double west = 0, south = 0, east = 0, north = 0;  ///< west > east across the antimeridian
};

/// Returns the area of a rectangle of a geographic or projected CRS. Its sides are divided into 16 parts,
/// since they are curves on the body. Throws Error{input} if a part of the rectangle has no image on the
/// body.
LonLatFootprint lonlat_footprint(const MapBox& box, const Crs& crs);

}  // namespace waymark::exporters
