// SPDX-License-Identifier: Apache-2.0
#include "geo/camera.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/solve.hpp"
#include "geo/distortion_limit.hpp"

namespace waymark::inline geo {
namespace {

struct Distorted {
  Eigen::Vector2d at;
  Eigen::Matrix2d jacobian;
};

// Brown 1966 with OpenCV's rational radial term: k = k1 k2 p1 p2 k3 k4 k5 k6.
Distorted brown(const std::array<double, 8>& k, const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y(), s = x * x + y * y;
  const double over = 1 + s * (k[0] + s * (k[1] + s * k[4])), d_over = k[0] + s * (2 * k[1] + s * 3 * k[4]);
  const double under = 1 + s * (k[5] + s * (k[6] + s * k[7])), d_under = k[5] + s * (2 * k[6] + s * 3 * k[7]);
  const double radial = over / under,
               slope = 2 * (d_over - radial * d_under) / under;  // d radial = slope r dr
  const double p1 = k[2], p2 = k[3];
  Distorted out;
  out.at = {x * radial + 2 * p1 * x * y + p2 * (s + 2 * x * x),
            y * radial + p1 * (s + 2 * y * y) + 2 * p2 * x * y};
  const double mixed = slope * x * y + 2 * p1 * x + 2 * p2 * y;
  out.jacobian << radial + slope * x * x + 2 * p1 * y + 6 * p2 * x, mixed,  //
      mixed, radial + slope * y * y + 6 * p1 * y + 2 * p2 * x;
  return out;
}

// Kannala and Brandt 2006 in OpenCV's form: the angle theta from the axis is imaged at radius
// theta (1 + k1 theta^2 + ... + k4 theta^8).
double fisheye_radius(const std::array<double, 8>& k, double theta) {
  const double s = theta * theta;
  return theta * (1 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
}

double fisheye_slope(const std::array<double, 8>& k, double theta) {
  const double s = theta * theta;
  return 1 + s * (3 * k[0] + s * (5 * k[1] + s * (7 * k[2] + s * 9 * k[3])));
}

double radial_radius(const std::array<double, 8>& k, double r) {
  const double s = r * r;
  return r * (1 + s * (k[0] + s * (k[1] + s * k[4]))) / (1 + s * (k[5] + s * (k[6] + s * k[7])));
}

// Solves f(r) = target for r in [0, field), f increasing, by doubling and bisection.
template <class Function>
std::optional<double> invert_increasing(const Function& f, double target, double field) {
  double low = 0, high = std::min(field, std::max(target, 1e-3));
  while (f(high) < target) {
    if (high >= field || high > 1e6) return std::nullopt;
    low = high;
    high = std::min(2 * high, field);
  }
  for (int step = 0; step < 60 && high - low > 1e-16 * high; ++step) {
    const double middle = (low + high) / 2;
    (f(middle) < target ? low : high) = middle;
  }
  return (low + high) / 2;
}

// Newton iterations from `p`. Steps are halved until they stay on the branch of the centre and reduce the
// residual.
std::optional<Eigen::Vector2d> refine_brown(const Camera& camera, const Eigen::Vector2d& goal,
                                            Eigen::Vector2d p, double field) {
  constexpr double kClose = 1e-13, kEnough = 1e-9;  // of the focal length
  const auto on_branch = [&](const Eigen::Vector2d& at, const Distorted& seen) {
    return at.norm() < field && seen.jacobian.determinant() > 0;
  };
  const double scale = 1 + goal.norm();
  Distorted here = brown(camera.distortion, p);
  if (!on_branch(p, here)) return std::nullopt;
  for (int step = 0; step < 50; ++step) {
    const Eigen::Vector2d miss = here.at - goal;
    if (miss.norm() < kClose * scale) return p;
    Eigen::Vector2d move = here.jacobian.inverse() * miss;
    bool closer = false;
    for (int halving = 0; halving < 30 && !closer; ++halving, move /= 2) {
      const Eigen::Vector2d next = p - move;
      const Distorted there = brown(camera.distortion, next);
      if (!on_branch(next, there) || !((there.at - goal).norm() < miss.norm())) continue;
      closer = true;
      p = next;
      here = there;
    }
    if (!closer) break;
  }
  return (here.at - goal).norm() < kEnough * scale ? std::optional(p) : std::nullopt;
}

std::optional<Eigen::Vector2d> undistort_brown(const Camera& camera, const Eigen::Vector2d& goal) {
  if (camera.distortion == std::array<double, 8>{}) return goal;
  const double field = distortion_limit(camera);
  if (goal.norm() < field)
    if (const auto p = refine_brown(camera, goal, goal, field)) return p;
  const double radius = goal.norm();
  if (!(radius > 0)) return std::nullopt;
  const auto start =
      invert_increasing([&](double r) { return radial_radius(camera.distortion, r); }, radius, field);
  // The tangential terms may extend slightly beyond the largest radius of the radial terms.
  const double from = start.value_or(std::isfinite(field) ? 0.95 * field : radius);
  return refine_brown(camera, goal, goal * (from / radius), field);
}

std::optional<Eigen::Vector3d> undistort_fisheye(const Camera& camera, const Eigen::Vector2d& goal) {
  const auto& k = camera.distortion;
  const double radius = goal.norm();
  if (!(radius > 0)) return radius == 0 ? std::optional(Eigen::Vector3d(0, 0, 1)) : std::nullopt;
  auto theta =
      invert_increasing([&](double t) { return fisheye_radius(k, t); }, radius, distortion_limit(camera));
  if (!theta) return std::nullopt;
  const double slope = fisheye_slope(k, *theta);
  if (slope > 0) *theta -= (fisheye_radius(k, *theta) - radius) / slope;
  const double sine = std::sin(*theta);
  return Eigen::Vector3d(goal.x() / radius * sine, goal.y() / radius * sine, std::cos(*theta));
}

std::optional<Eigen::Vector2d> project_from(const Camera& camera, const Eigen::Isometry3d& pose,
                                            const Eigen::Vector3d& point) {
  // Subtracting the centre first preserves millimetres for northings of seven digits.
  const Eigen::Vector3d away = point - pose.translation();
  return project(camera, Point<CameraFrame>{pose.linear().transpose() * away});
}

// The motion is held beyond half an image from the border: points far outside must not make it endless.
Eigen::Isometry3d pose_at_row(const PosedCamera& view, double row) {
  return moved_pose(view.grid_from_camera.transform, *view.motion,
                    std::clamp(readout_fraction(view.camera, row), -1.0, 1.0));
}

std::optional<Eigen::Vector2d> project_moving(const PosedCamera& view, const Eigen::Vector3d& point) {
  constexpr int kSteps = 50;
  constexpr double kClose = 1e-6;  // px
  auto seen = project_from(view.camera, view.grid_from_camera.transform, point);
  for (int step = 0; step < kSteps && seen; ++step) {
    const double row = seen->y();
    seen = project_from(view.camera, pose_at_row(view, row), point);
    if (seen && std::abs(seen->y() - row) < kClose) return seen;
  }
  return std::nullopt;
}

}  // namespace

double readout_fraction(const Camera& camera, double row) {
  return camera.rows > 1 ? row / static_cast<double>(camera.rows - 1) - 0.5 : 0;
}

Eigen::Isometry3d moved_pose(const Eigen::Isometry3d& world_from_camera, const ShutterMotion& motion,
                             double fraction) {
  Eigen::Isometry3d pose = world_from_camera;
  pose.linear() = world_from_camera.linear() * rotation_by(fraction * motion.turn);
  pose.translation() += fraction * motion.shift;
  return pose;
}

std::optional<Eigen::Vector2d> project(const Camera& camera, const Point<CameraFrame>& point) {
  const Eigen::Vector3d& at = point.xyz;
  if (!(at.z() > 0)) return std::nullopt;
  Eigen::Vector2d seen = at.head<2>() / at.z();
  if (camera.lens == Camera::Lens::fisheye) {
    const double radius = seen.norm(), theta = std::atan(radius);
    if (!(theta < distortion_limit(camera))) return std::nullopt;
    if (radius > 0) seen *= fisheye_radius(camera.distortion, theta) / radius;
  } else if (camera.distortion != std::array<double, 8>{}) {
    if (!(seen.norm() < distortion_limit(camera))) return std::nullopt;
    const Distorted there = brown(camera.distortion, seen);
    if (!(there.jacobian.determinant() > 0)) return std::nullopt;
    seen = there.at;
  }
  const Eigen::Vector2d pixel(camera.fx * seen.x() + camera.skew * seen.y() + camera.cx,
                              camera.fy * seen.y() + camera.cy);
  return pixel.allFinite() ? std::optional(pixel) : std::nullopt;
}

std::optional<Direction<CameraFrame>> ray(const Camera& camera, const Eigen::Vector2d& pixel) {
  if (!pixel.allFinite()) return std::nullopt;
  const double y = (pixel.y() - camera.cy) / camera.fy;
  const Eigen::Vector2d goal((pixel.x() - camera.cx - camera.skew * y) / camera.fx, y);
  if (camera.lens == Camera::Lens::fisheye) {
    const auto along = undistort_fisheye(camera, goal);
    if (!along) return std::nullopt;
    return Direction<CameraFrame>{*along};
  }
  const auto seen = undistort_brown(camera, goal);
  if (!seen) return std::nullopt;
  return Direction<CameraFrame>{Eigen::Vector3d(seen->x(), seen->y(), 1).normalized()};
}

std::optional<Ray<GridFrame>> ray(const PosedCamera& view, const Eigen::Vector2d& pixel) {
  const auto along = ray(view.camera, pixel);
  if (!along) return std::nullopt;
  if (!view.motion) return Ray<GridFrame>{view.centre(), view.grid_from_camera * *along};
  const Eigen::Isometry3d pose = pose_at_row(view, pixel.y());
  return Ray<GridFrame>{{pose.translation()}, {pose.linear() * along->unit}};
}

std::optional<Eigen::Vector2d> project(const PosedCamera& view, const Point<GridFrame>& point) {
  return view.motion ? project_moving(view, point.xyz)
                     : project_from(view.camera, view.grid_from_camera.transform, point.xyz);
}

}  // namespace waymark::inline geo
