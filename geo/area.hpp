// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
namespace waymark::inline geo {

/// Area of interest: polygons, each an outer ring and its holes, in the CRS of the map.
class Area {
 public:
  using Ring = std::vector<Eigen::Vector2d>;  ///< closed or not

  /// `degrees`: x is a longitude, equal modulo 360.
  Area(std::vector<std::vector<Ring>> polygons, bool degrees);

  /// Returns whether a polygon contains the point; on the boundary either answer. O(corners).
  bool contains(double x, double y) const;

 private:
  struct Part {
    std::vector<Ring> rings;
    Eigen::Vector2d low, high;
  };
  std::vector<Part> parts_;
  bool degrees_;
};

}  // namespace waymark::inline geo
