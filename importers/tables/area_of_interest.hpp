// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>
#include "geo/georeference.hpp"
namespace waymark::importers {

/// Area of interest: polygons, each an outer ring and its holes, in the CRS of the map.
class Area {
 public:
  using Ring = std::vector<Eigen::Vector2d>;  ///< closed or not

  /// `degrees`: x is a longitude, equal modulo 360.
  Area(std::vector<std::vector<Ring>> polygons, bool degrees);

  /// Returns whether a polygon contains the point; on the boundary either answer. O(corners).
  bool contains(double x, double y) const;
  /// Returns the box of all polygons.
  Eigen::AlignedBox2d box() const;

 private:
  struct Part {
    std::vector<Ring> rings;
    Eigen::Vector2d low, high;
  };
  std::vector<Part> parts_;
  bool degrees_;
};

/// Reads all polygons of a vector file, of every layer, as one area in the CRS `into`. Long edges are divided
/// before they are transformed. A layer without a CRS is taken to be in `into`; if `into` is local, every
/// layer is. Throws Error{input} if there is no such file or it holds no polygon, and for another body.
Area read_area_of_interest(const std::string& path, const Crs& into);

/// Throws Error{input} if the boxes of the area, read from `path`, and of the grid do not meet. `data` names
/// the grid in the message, e.g. "the DEM". Longitudes are equal modulo 360 degrees.
void check_area_meets(const Area& area, const GridGeometry& grid, const std::string& data,
                      const std::string& path);

}  // namespace waymark::importers
