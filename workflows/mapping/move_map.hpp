// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "geodb/map_contents.hpp"
#include "localization/registration/circle_evidence.hpp"
namespace waymark::workflows {

/// Similarity that moves a map: x and y by `plane`, in metres; heights by its scale and `lift`.
struct MapMove {
  localization::PlaneSimilarity plane = {};
  double lift = 0;                                  ///< new height of height 0, metres
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< of the covariance, in the new frame
  /// Of x and y of the pivot, the yaw, ln of the scale, and the height of the pivot.
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Zero();
};

/// Returns the metres per unit of a projected CRS; 1 for others.
double metres_of(const Crs& crs);

/// Moves landmarks, observations, images and layers of a map, which get the CRS `crs`.
/// - Covariances of positions are turned and scaled, and increased by the covariance of the move. Unknown
///   ones stay unknown.
/// - Features and attributes in metres (m2, m3) are scaled, elevations moved, axes turned; attribute pairs
///   `<stem>_x`, `<stem>_y` are positions.
/// - Landmarks are moved when they are read: `contents` keeps its source.
/// - Elevation tiles are not moved: `moved_dem` does.
void move_map(geodb::MapContents& contents, const MapMove& move, const Crs& crs);

}  // namespace waymark::workflows
