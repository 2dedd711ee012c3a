// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "core/detection.hpp"
#include "pipeline/fusion/sight.hpp"
namespace waymark {

/// Errors of a place that do not come from image and pose; standard deviations in metres.
struct PlaceErrors {
  double height_sd = 0;  ///< of the ground: moves the place along the line of sight
  double along_sun = 0;  ///< level, towards or from the sun
  double all_round = 0;  ///< level, in any direction
};

/// Covariance (east, north, up; square metres) of the point of the ground plane that the middle of a
/// detection shows: S = J_px S_px J_px' + J_pose S_pose J_pose' + j_z s_z^2 j_z' + shape. The ground plane
/// carries a level error into height. All errors but those of the detection are shared by an image.
/// Zero-filled where the line of sight does not meet the plane.
Eigen::Matrix3d place_covariance(const Detection& detection, const ImageView& image,
                                 const GroundPlane& ground, const PlaceErrors& errors);

/// How the met point moves with the pose: columns are rotations about the camera's axes, then the centre, as
/// in PosedCamera::covariance. Zero for an orthophoto.
Eigen::Matrix<double, 3, 6> pose_jacobian(const ImageView& image, const Ray<GridFrame>& line,
                                          const GroundPlane& ground);

/// Relative error of lengths from that of the distance camera to ground; 0 for an orthophoto.
double relative_scale_sd(const ImageView& image, const Ray<GridFrame>& line, double range);

}  // namespace waymark
