// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include "core/frames.hpp"
namespace waymark::inline geo {

/// Central camera. Pixel (0, 0) is the centre of the first pixel, x to the right, y down; OpenCV axes.
struct Camera {
  enum class Lens {
    brown,    ///< OpenCV's rational Brown model: k1 k2 p1 p2 k3 k4 k5 k6
    fisheye,  ///< OpenCV's equidistant model: k1 k2 k3 k4
  };
  std::int64_t columns = 0, rows = 0;
  double fx = 0, fy = 0;  ///< focal lengths, pixels
  double cx = 0, cy = 0;  ///< principal point, pixels
  double skew = 0;        ///< x = fx x' + skew y' + cx
  Lens lens = Lens::brown;
  std::array<double, 8> distortion{};  ///< in OpenCV's order; unused coefficients are 0

  friend bool operator==(const Camera&, const Camera&) = default;
};

/// Projects a point to the image plane, inside the image or not. `std::nullopt` for points at or behind the
/// camera's plane, and beyond the limit up to which the distortion is invertible.
std::optional<Eigen::Vector2d> project(const Camera& camera, const Point<CameraFrame>& point);

/// Returns the direction of the ray through a pixel; `std::nullopt` if the distortion is not invertible
/// there. Newton iterations to 1e-9 of the focal length; project(ray(p) * t) == p within 1e-6 px.
std::optional<Direction<CameraFrame>> ray(const Camera& camera, const Eigen::Vector2d& pixel);

/// Motion of a camera from the first row of its image to the last, at constant velocity: a rolling shutter. A
/// row is taken when its fraction of this motion, counted from the middle row, is done.
struct ShutterMotion {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< of the centre, in the frame of the pose
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();   ///< rotation vector about the axes of the camera, radians

  friend bool operator==(const ShutterMotion&, const ShutterMotion&) = default;
};

/// Returns when a row is read out, as a fraction of the readout time after the middle row: [-0.5, 0.5].
double readout_fraction(const Camera& camera, double row);

/// Returns the pose of a camera after a fraction of its motion.
Eigen::Isometry3d moved_pose(const Eigen::Isometry3d& world_from_camera, const ShutterMotion& motion,
                             double fraction);

/// Camera with its pose. The covariance is of the rotation (radians, about the axes of the camera frame),
/// then of the centre (metres, grid frame).
struct PosedCamera {
  Camera camera;
  Pose<GridFrame, CameraFrame> grid_from_camera;
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// While the rows were read out; none: the shutter is global, or the motion is unknown.
  std::optional<ShutterMotion> motion = {};

  /// Returns the projection centre of the middle row.
  Point<GridFrame> centre() const { return {grid_from_camera.transform.translation()}; }
};

/// Returns the ray from the projection centre, when the row was taken, through a pixel; `std::nullopt` if the
/// distortion is not invertible there.
std::optional<Ray<GridFrame>> ray(const PosedCamera& view, const Eigen::Vector2d& pixel);
/// Projects a point of the grid frame; `std::nullopt` as for a Camera, and where the pose that sees the point
/// is not found. The pose of a moving camera follows from the row, and the row from the pose: fixed-point
/// iteration to 1e-6 px, 3 to 6 projections where the image moves by a twentieth of its height.
std::optional<Eigen::Vector2d> project(const PosedCamera& view, const Point<GridFrame>& point);

}  // namespace waymark::inline geo
