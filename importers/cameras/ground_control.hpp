// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>
namespace waymark::importers {

/// Mark of a surveyed point.
struct GroundControlMark {
  std::string image = {};
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< (0, 0) is the centre of the first pixel
};

/// Surveyed point with its marks.
struct GroundControlPoint {
  std::string name = {};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in `GroundControl::crs`; z is NaN if unknown
  std::vector<GroundControlMark> marks = {};
};

/// Surveyed points of a file.
struct GroundControl {
  std::string crs = {};  ///< as PROJ reads it
  std::vector<GroundControlPoint> points = {};
};

/// Reads OpenDroneMap's gcp_list.txt: the CRS on the first line ("EPSG:32632", "WGS84 UTM 32N", a PROJ
/// string), then "easting northing height column row image [name]". Lines with the same name, or without
/// names the same coordinates, are one point. Throws Error{input} with the line for a missing or invalid
/// number, and for a point with two positions, or two marks in one image.
GroundControl read_gcp_list(const std::string& path);

}  // namespace waymark::importers
