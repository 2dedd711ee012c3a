// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include "geo/crs.hpp"
#include "geo/similarity.hpp"
#include "importers/cameras/camera_file.hpp"
namespace waymark::importers {

/// Transforms a point from the frame of a camera file to the grid frame. NaN for a point outside the domain
/// of the projection.
using WorldToGrid = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// Returns the transform. `camera_crs` applies if the file names no CRS; if it is empty, the map's. Heights
/// change by `height_offset` only. Throws Error{input} if the two CRSs have no common body, or if `world` is
/// arbitrary and needs a similarity.
WorldToGrid world_to_grid(const CameraWorld& world, const std::string& camera_crs, const Crs& map,
                          double height_offset, const std::string& path);

/// Linear part of the transform at a position: the nearest rotation, and the ratio of the longest to the
/// shortest axis (1: conformal), by central differences over 2 x 10 m.
struct LocalRotation {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double stretch = 1;
};
LocalRotation local_rotation_at(const WorldToGrid& to_grid, const Eigen::Vector3d& place);

}  // namespace waymark::importers
