// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include "core/detection.hpp"
#include "pipeline/fusion/projection/viewing_ray.hpp"
namespace waymark::pipeline {

/// Position errors other than those of image and pose; standard deviations in metres.
struct PositionErrors {
  double height_sd = 0;     ///< of the ground: shifts the position along the line of sight
  double along_sun_sd = 0;  ///< horizontal, towards or away from the sun
  double isotropic_sd = 0;  ///< horizontal, isotropic
};

/// Returns the covariance (east, north, up; square metres) of the point of the ground plane at the centre of
/// a detection:
///   S = J_px S_px J_px' + J_pose S_pose J_pose' + j_z s_z^2 j_z' + shape.
/// The ground plane propagates horizontal errors into height. All errors but those of the detection are
/// common to an image.
/// Zero if the line of sight misses the plane.
Eigen::Matrix3d position_covariance(const Detection& detection, const ImageView& image,
                                    const GroundPlane& ground, const PositionErrors& errors);

/// Returns the Jacobian of the intersection point with respect to the pose: rotations about the camera's
/// axes, then the centre, as in PosedCamera::covariance. Zero for an orthophoto.
Eigen::Matrix<double, 3, 6> pose_jacobian(const ImageView& image, const Ray<GridFrame>& line,
                                          const GroundPlane& ground);

/// Returns the relative error of lengths due to the distance from camera to ground; 0 for an orthophoto.
double relative_range_sd(const ImageView& image, const Ray<GridFrame>& line, double range);

}  // namespace waymark::pipeline
