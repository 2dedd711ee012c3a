// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/position_covariance.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace waymark::pipeline {
namespace {

// Returns a horizontal shift with the rise of the ground along it.
Eigen::Vector3d along_ground(const Eigen::Vector2d& level, const GroundPlane& ground) {
  return {level.x(), level.y(), ground.gradient.dot(level)};
}

}  // namespace

Eigen::Matrix<double, 3, 6> pose_jacobian(const ImageView& image, const Ray<GridFrame>& line,
                                          const GroundPlane& ground) {
  Eigen::Matrix<double, 3, 6> jacobian = Eigen::Matrix<double, 3, 6>::Zero();
  if (!image.view) return jacobian;
  const auto met = intersect(line, ground);
  if (!met) return jacobian;
  const double range = (*met - line.origin.xyz).norm();
  const Eigen::Vector3d n = ground.normal(), d = line.direction.unit;
  // Projects a shift onto the plane along the line of sight.
  const Eigen::Matrix3d back = Eigen::Matrix3d::Identity() - d * n.transpose() / n.dot(d);
  const Eigen::Matrix3d rotation = image.view->grid_from_camera.transform.linear();
  const Eigen::Vector3d in_camera = rotation.transpose() * d;
  for (int axis = 0; axis < 3; ++axis)
    jacobian.col(axis) = range * back * rotation * Eigen::Vector3d::Unit(axis).cross(in_camera);
  jacobian.rightCols<3>() = back;
  return jacobian;
}

double relative_range_sd(const ImageView& image, const Ray<GridFrame>& line, double range) {
  if (!image.view || !(range > 0)) return 0;
  const Eigen::Matrix3d centre = image.view->covariance.bottomRightCorner<3, 3>();
  const Eigen::Vector3d d = line.direction.unit;
  return std::sqrt(std::max(d.dot(centre * d), 0.0)) / range;
}

Eigen::Matrix3d position_covariance(const Detection& detection, const ImageView& image,
                                    const GroundPlane& ground, const PositionErrors& errors) {
  const Eigen::Vector2d pixel(detection.outline.x, detection.outline.y);
  const auto line = viewing_ray(image, pixel);
  Eigen::Matrix3d total = Eigen::Matrix3d::Zero();
  if (!line) return total;
  Eigen::Matrix<double, 3, 2> per_pixel;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d half = Eigen::Vector2d::Unit(axis) / 2;
    const auto ahead = viewing_ray(image, pixel + half), behind = viewing_ray(image, pixel - half);
    if (!ahead || !behind) return total;
    const auto to = intersect(*ahead, ground), from = intersect(*behind, ground);
    if (!to || !from) return total;
    per_pixel.col(axis) = *to - *from;
  }
  total += per_pixel * detection.covariance * per_pixel.transpose();
  if (image.view) {
    const auto per_pose = pose_jacobian(image, *line, ground);
    total += per_pose * image.view->covariance * per_pose.transpose();
  }
  const Eigen::Vector3d n = ground.normal(), d = line->direction.unit;
  const Eigen::Vector3d per_height = d * (n.z() / n.dot(d));
  total += errors.height_sd * errors.height_sd * per_height * per_height.transpose();
  if (image.sun && errors.along_sun_sd > 0) {
    const Eigen::Vector3d move = along_ground(sun_direction(*image.sun).unit.head<2>().normalized(), ground);
    total += errors.along_sun_sd * errors.along_sun_sd * move * move.transpose();
  }
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d move = along_ground(Eigen::Vector2d::Unit(axis), ground);
    total += errors.isotropic_sd * errors.isotropic_sd * move * move.transpose();
  }
  return (total + total.transpose()) / 2;
}

}  // namespace waymark::pipeline
