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
  double sd = 1;                                    ///< of each coordinate, pixels
};

/// Surveyed point with its marks.
struct GroundControlPoint {
  std::string name = {};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in `GroundControl::crs`; z is NaN if unknown
  std::vector<GroundControlMark> marks = {};
  Eigen::Vector3d sd = Eigen::Vector3d::Constant(0.05);  ///< metres
  bool check = false;                                    ///< reported, but never used
};

/// Surveyed points of a file.
struct GroundControl {
  std::string crs = {};  ///< as PROJ reads it; empty: unknown
  std::vector<GroundControlPoint> points = {};
};

/// Reads OpenDroneMap's gcp_list.txt: the CRS on the first line ("EPSG:32632", "WGS84 UTM 32N", a PROJ
/// string), then "easting northing height column row image [name]". Lines with the same name, or without
/// names the same coordinates, are one point. Points whose names begin with "check" are check points. Throws
/// Error{input} with the line for a missing or invalid number, and for a point with two positions, or two
/// marks in one image.
GroundControl read_gcp_list(const std::string& path);

/// Reads surveyed points from a vector layer or a CSV table, and their marks from another table
/// (docs/reference/control_points.md). Throws Error{input} with file and line for a missing column or number
/// and two points of one name; also for a mark of an unknown point and two marks of a point in one image.
GroundControl read_control_layer(const std::string& points, const std::string& marks);

/// Reads surveyed points as read_gcp_list does if `marks` is empty, else as read_control_layer. Throws
/// Error{usage} for a vector layer without marks.
GroundControl read_ground_control(const std::string& points, const std::string& marks);

/// Returns whether a name is that of a check point: it begins with "check", in any case.
bool is_check_name(const std::string& name);

}  // namespace waymark::importers
