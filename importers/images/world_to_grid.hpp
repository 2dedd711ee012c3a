// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include "geo/crs.hpp"
#include "importers/images/camera_file.hpp"
#include "importers/images/similarity.hpp"
namespace waymark {

/// From the frame of a camera file to the grid frame, point by point. NaN where a point has no image.
using WorldToGrid = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// `camera_crs` is used where the file names none; the map's where that is empty too. Heights are not changed
/// but for `height_offset`. Throws Error{input} where the two do not meet, or `world` is arbitrary: use the
/// similarity.
WorldToGrid world_to_grid(const CameraWorld& world, const std::string& camera_crs, const Crs& map,
                          double height_offset, const std::string& path);

/// How a small cross of axes at a place comes out in the grid: the nearest rotation, and the ratio of the
/// longest to the shortest axis (1: true to shape), by central differences over 2 x 10 m.
struct LocalTurn {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double stretch = 1;
};
LocalTurn turn_at(const WorldToGrid& to_grid, const Eigen::Vector3d& place);

}  // namespace waymark
