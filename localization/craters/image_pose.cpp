// SPDX-License-Identifier: Apache-2.0
#include "localization/craters/image_pose.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/solve.hpp"

namespace waymark::localization {
namespace {

Eigen::Vector3d north_of(const Eigen::Vector3d& up) {
  const Eigen::Vector3d north = Eigen::Vector3d::UnitZ() - up.z() * up;
  return north.norm() > 1e-12 ? Eigen::Vector3d(north.normalized()) : Eigen::Vector3d::UnitX();
}

}  // namespace

Eigen::Vector3d BodySurface::up(const Eigen::Vector3d& on_surface) const {
  const Eigen::Vector3d p = squeezed(on_surface);
  return Eigen::Vector3d(p.x() / equatorial_, p.y() / equatorial_, p.z() / polar_).normalized();
}

Eigen::Vector3d BodySurface::nearest(const Eigen::Vector3d& point) const {
  return point / squeezed(point).norm();
}

std::optional<Eigen::Vector3d> BodySurface::hit(const Eigen::Vector3d& from,
                                                const Eigen::Vector3d& along) const {
  const Eigen::Vector3d p = squeezed(from), d = squeezed(along);
  const double a = d.squaredNorm(), b = p.dot(d), c = p.squaredNorm() - 1, root = b * b - a * c;
  if (!(root >= 0) || !(a > 0)) return std::nullopt;
  const double t = (-b - std::sqrt(root)) / a;
  return t > 0 ? std::optional<Eigen::Vector3d>(from + t * along) : std::nullopt;
}

double BodySurface::area() const {
  const double r = std::cbrt(equatorial_ * equatorial_ * polar_);
  return 4 * std::numbers::pi * r * r;
}

ImagePose ImagePose::moved(const Step& step, const BodySurface& surface) const {
  ImagePose next = *this;
  next.ground = surface.nearest(ground + step[0] * axes.col(0) + step[1] * axes.col(1));
  const Eigen::Vector3d up = surface.up(next.ground);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(-step[3], up) * rotation_between(-axes.col(2), up);
  next.axes = turn * axes;
  // Rounding must not add up over many steps.
  next.axes.col(2) = -up;
  next.axes.col(0) = (next.axes.col(0) - next.axes.col(0).dot(up) * up).normalized();
  next.axes.col(1) = next.axes.col(2).cross(next.axes.col(0));
  next.log_scale += step[2];
  next.tilt += step.tail<2>();
  return next;
}

double ImagePose::azimuth() const {
  const Eigen::Vector3d up = -axes.col(2), north = north_of(up), east = north.cross(up);
  return std::atan2(-axes.col(1).dot(east), -axes.col(1).dot(north));
}

ImagePose image_pose(const BodySurface& surface, const Eigen::Vector3d& ground, double metres_per_pixel,
                     double azimuth) {
  ImagePose pose;
  pose.ground = surface.nearest(ground);
  const Eigen::Vector3d up = surface.up(pose.ground), north = north_of(up), east = north.cross(up);
  pose.axes.col(0) = std::cos(azimuth) * east - std::sin(azimuth) * north;
  pose.axes.col(1) = -std::sin(azimuth) * east - std::cos(azimuth) * north;
  pose.axes.col(2) = -up;
  pose.log_scale = std::log(metres_per_pixel);
  return pose;
}

Eigen::Matrix3d GroundCamera::tilted_axes(const ImagePose& pose) const {
  return rotation_by(pose.tilt.x() * pose.axes.col(0) + pose.tilt.y() * pose.axes.col(1)) * pose.axes;
}

std::optional<ImagePoint> GroundCamera::project(const ImagePose& pose, const Eigen::Vector3d& point,
                                                const Eigen::Vector3d& up) const {
  const Eigen::Matrix3d axes = tilted_axes(pose);
  const Eigen::Vector3d at = axes.transpose() * (point - pose.ground);
  const double scale = std::exp(pose.log_scale);
  if (focal_ == 0) {
    const double facing = -up.dot(axes.col(2));
    if (!(facing > 0)) return std::nullopt;
    return ImagePoint{at.head<2>() / scale, std::sqrt(facing) / scale};
  }
  const double depth = at.z() + focal_ * scale;
  if (!(depth > 0)) return std::nullopt;
  const Eigen::Vector3d to_camera = pose.ground - focal_ * scale * axes.col(2) - point;
  const double facing = up.dot(to_camera) / to_camera.norm();
  if (!(facing > 0)) return std::nullopt;
  return ImagePoint{focal_ / depth * at.head<2>(), focal_ / depth * std::sqrt(facing)};
}

std::optional<Eigen::Vector3d> GroundCamera::ground(const ImagePose& pose, const Eigen::Vector2d& pixel,
                                                    const BodySurface& surface) const {
  const Eigen::Matrix3d axes = tilted_axes(pose);
  const double scale = std::exp(pose.log_scale);
  if (focal_ == 0)
    return surface.hit(pose.ground + scale * (pixel.x() * axes.col(0) + pixel.y() * axes.col(1)) -
                           surface.radius() * axes.col(2),
                       axes.col(2));
  const Eigen::Vector3d along =
      (pixel.x() * axes.col(0) + pixel.y() * axes.col(1) + focal_ * axes.col(2)).normalized();
  return surface.hit(pose.ground - focal_ * scale * axes.col(2), along);
}

std::optional<Eigen::Vector3d> GroundCamera::position(const ImagePose& pose) const {
  if (focal_ == 0) return std::nullopt;
  return pose.ground - focal_ * std::exp(pose.log_scale) * tilted_axes(pose).col(2);
}

}  // namespace waymark::localization
