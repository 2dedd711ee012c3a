// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "geodb/map_contents.hpp"
#include "localization/registration/circle_evidence.hpp"
namespace waymark::workflows {

/// Similarity that moves a map: x and y by `plane`, in metres; heights scale about `height`.
struct MapMove {
  localization::PlaneSimilarity plane = {};
  Eigen::Vector2d pivot = Eigen::Vector2d::Zero();       ///< of the covariance, in the new frame
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< shift of the pivot, yaw, ln of the scale
  double height = 0;                                     ///< that stays, metres
};

/// Returns the metres per unit of a projected CRS; 1 for others.
double metres_of(const Crs& crs);

/// Moves landmarks, observations, images and layers of a map, which get the CRS `crs`.
/// - Covariances of positions are turned and scaled, and increased by the covariance of the move. Unknown
///   ones stay unknown.
/// - Features and attributes in metres (m2, m3) are scaled, elevations moved, axes turned; attribute pairs
///   `<stem>_x`, `<stem>_y` are positions.
/// - Landmarks are moved when they are read: `contents` keeps its source.
/// - Elevation tiles are not moved; the caller leaves them out.
void move_map(geodb::MapContents& contents, const MapMove& move, const Crs& crs);

}  // namespace waymark::workflows
