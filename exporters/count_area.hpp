// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>
#include "exporters/report/relief_source.hpp"
#include "geo/crs.hpp"
namespace waymark {

class MapStore;

/// The ground a map's landmarks were looked for on: what densities are counted per.
struct CountArea {
  struct Ring {
    std::vector<Eigen::Vector2d> corners;  ///< closed, CRS units of the map; every side short
    bool hole = false;
  };
  double square_metres = 0;  ///< on the ground, > 0
  std::vector<Ring> rings;   ///< empty where only the area is known
  std::string from;          ///< "the footprints of 12 images", "the DEM"
};

/// The union of the images' footprints; without images the cells of the DEM that have heights, read at the
/// resolution of a picture (its rim is good to 0.1 %). Nothing where neither is known, as for a catalogue.
/// Areas are equal-area on the body's ellipsoid for footprints, on its sphere for a DEM.
std::optional<CountArea> count_area(const MapStore& map);

/// Ground area of the cells that have a height, square metres.
double area_of(const Relief& relief, const Crs& crs);

/// Area of a polygon with holes in any CRS, square metres; 0 for a polygon without area.
double ground_area(const std::vector<CountArea::Ring>& rings, const Crs& crs);

}  // namespace waymark
