// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>
#include "exporters/report/relief_source.hpp"
#include "geo/crs.hpp"
namespace waymark::geodb {
class MapStore;
}

namespace waymark::exporters {

/// The area in which the landmarks of a map were counted, for densities.
struct CountingArea {
  struct Ring {
    std::vector<Eigen::Vector2d> corners;  ///< closed, CRS units of the map; every side short
    bool hole = false;
  };
  double square_metres = 0;  ///< on the ground, > 0
  std::vector<Ring> rings;   ///< empty if only the area is known
  std::string source;        ///< "the footprints of 12 images", "the DEM"
};

/// Returns the union of the images' footprints; without images the cells of the DEM that have heights, read
/// at picture resolution (accurate to 0.1 %). `std::nullopt` if neither is known, as for a catalogue. Areas
/// are on the body's ellipsoid for footprints, on its sphere for a DEM.
std::optional<CountingArea> counting_area(const geodb::MapStore& map);

/// Returns the ground area of the cells that have a height, square metres.
double area_of(const Relief& relief, const Crs& crs);

/// Returns the area of a polygon with holes in any CRS, square metres; 0 for a degenerate polygon.
double polygon_area(const std::vector<CountingArea::Ring>& rings, const Crs& crs);

}  // namespace waymark::exporters
