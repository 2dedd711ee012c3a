// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include "core/frames.hpp"
#include "exporters/report/relief_source.hpp"
#include "geo/crs.hpp"
#include "geo/local_frame.hpp"
namespace waymark::exporters {

/// East, north, up in metres about a point near the middle of a view. It is the map frame, shifted.
class ViewFrame {
 public:
  ViewFrame(const Crs& crs, const LocalFrame& frame, const Eigen::Vector3d& middle)
      : crs_(crs), frame_(frame), middle_(middle) {}

  const Crs& crs() const { return crs_; }
  /// Returns the position of a point of the map's CRS.
  Eigen::Vector3d from_crs(const Point<MapCrs>& point) const;
  /// Returns the position of a point of the map frame.
  Eigen::Vector3d from_map_frame(const Eigen::Vector3d& point) const { return point - middle_; }
  /// Returns the CRS coordinates of a position; longitudes within half a turn of the middle.
  Eigen::Vector3d to_crs(const Eigen::Vector3d& at) const;
  /// Returns the rotation from axes of the grid (easting, northing, height) at a point of the CRS.
  Eigen::Matrix3d rotation_from_grid(const Point<MapCrs>& at) const;

 private:
  Crs crs_;
  LocalFrame frame_;
  Eigen::Vector3d middle_;
};

/// CRS coordinates at positions of a rectangle of the view frame: exact at 33 x 33 nodes, bilinear between.
class CrsGrid {
 public:
  CrsGrid(const ViewFrame& frame, const Eigen::AlignedBox2d& area);

  /// Returns x, y of the CRS, and the height in the CRS of the plane z = 0 of the view frame.
  Eigen::Vector3d at(const Eigen::Vector2d& position) const;
  /// Returns the rectangle of the CRS that contains all nodes.
  Extent extent() const;

 private:
  Eigen::AlignedBox2d area_;
  std::vector<Eigen::Vector3d> nodes_;
};

}  // namespace waymark::exporters
