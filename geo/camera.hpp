// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include "core/frames.hpp"
namespace waymark {

/// A central camera. Pixel (0, 0) is the centre of the first pixel, x to the right, y down; OpenCV axes.
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
  std::array<double, 8> distortion{};  ///< in OpenCV's order; unused ones 0

  friend bool operator==(const Camera&, const Camera&) = default;
};

/// Where a point appears, inside the image or not. Nothing for a point at or behind the camera's plane, or
/// beyond the field in which the distortion can be inverted (a far point must not fold back into the image).
std::optional<Eigen::Vector2d> project(const Camera& camera, const Point<CameraFrame>& point);

/// The direction a pixel looks in. Nothing where the distortion does not invert.
/// Newton iterations to 1e-9 of the focal length; project(ray(p) * t) == p within 1e-6 px.
std::optional<Direction<CameraFrame>> ray(const Camera& camera, const Eigen::Vector2d& pixel);

/// A camera at a place. Covariance of the pose: rotation first (radians, about the axes of the camera frame),
/// then the centre (metres, grid frame).
struct PosedCamera {
  Camera camera;
  Pose<GridFrame, CameraFrame> grid_from_camera;
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  Point<GridFrame> centre() const { return {grid_from_camera.transform.translation()}; }
};

/// Ray through a pixel, from the camera's centre; nothing where the distortion does not invert.
std::optional<Ray<GridFrame>> ray(const PosedCamera& view, const Eigen::Vector2d& pixel);
std::optional<Eigen::Vector2d> project(const PosedCamera& view, const Point<GridFrame>& point);

}  // namespace waymark
