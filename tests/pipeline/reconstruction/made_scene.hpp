// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "core/random.hpp"
#include "geo/camera.hpp"
#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::test {

struct MadeSceneOptions {
  std::uint64_t seed = 1;
  int columns = 4, rows = 3;  ///< of the grid of cameras
  double base = 25;           ///< between cameras, metres; they fly at 100 m, and each sees 100 m x 75 m
  double relief = 10;         ///< of the ground, metres
  double tilt = 0;            ///< of the cameras, alternately to all sides, radians
  int points = 200;
  double mark_sd = 0.5;  ///< pixels
  Camera camera = {.columns = 1000, .rows = 750, .fx = 1000, .fy = 1000, .cx = 499.5, .cy = 374.5};
  Eigen::Vector3d corner = {0, 0, 0};  ///< of the ground
};

/// Aerial block with its truth.
struct MadeScene {
  pipeline::Reconstruction truth = {};
  pipeline::Reconstruction start = {};  ///< truth with disturbed poses (0.5 m, 0.01 rad) and points (0.5 m)
  pipeline::Observations seen = {};     ///< empty
};

inline Eigen::Vector3d normal_vector(Random& random, double sd) {
  const double x = random.normal(0, sd), y = random.normal(0, sd), z = random.normal(0, sd);
  return {x, y, z};
}

inline double ground(double x, double y, double relief) {
  return relief * (std::sin(x / 13) * std::cos(y / 17) + 0.5 * std::sin((x + 2 * y) / 7));
}

inline Eigen::Isometry3d looking_down(const Eigen::Vector3d& centre, double about_x, double about_y) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()))
                      .toRotationMatrix() *
                  Eigen::Vector3d(1, -1, -1).asDiagonal();
  pose.translation() = centre;
  return pose;
}

inline std::vector<pipeline::Mark> marks_of(const pipeline::Reconstruction& truth,
                                            const Eigen::Vector3d& point, double sd, Random& random) {
  std::vector<pipeline::Mark> marks;
  for (std::size_t i = 0; i < truth.images.size(); ++i) {
    const Camera& camera = truth.lenses[0].camera;
    const auto pixel = project(camera, {truth.images[i].world_from_camera->inverse() * point});
    if (!pixel || !((*pixel).minCoeff() > 0) || !(pixel->x() < static_cast<double>(camera.columns)) ||
        !(pixel->y() < static_cast<double>(camera.rows)))
      continue;
    const double u = random.normal(0, sd), v = random.normal(0, sd);
    marks.push_back({i, *pixel + Eigen::Vector2d(u, v), sd > 0 ? sd : 1});
  }
  return marks;
}

/// Moves poses and points by about a hundredth of a radian and half a metre: a start that an adjustment
/// mends.
inline void disturb(pipeline::Reconstruction& scene, Random& random) {
  for (pipeline::AdjustedImage& image : scene.images) {
    const Eigen::Vector3d turn = normal_vector(random, 0.01);
    image.world_from_camera->linear() *= Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    image.world_from_camera->translation() += normal_vector(random, 0.5);
  }
  for (pipeline::TiePoint& point : scene.points) *point.position += normal_vector(random, 0.5);
}

/// Returns the error of a pose: rotation vector about the camera's axes, then centre.
inline Eigen::Matrix<double, 6, 1> pose_error(const pipeline::AdjustedImage& found,
                                              const pipeline::AdjustedImage& truth) {
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(truth.world_from_camera->linear().transpose() * found.world_from_camera->linear()));
  Eigen::Matrix<double, 6, 1> error;
  error << turn.angle() * turn.axis(),
      found.world_from_camera->translation() - truth.world_from_camera->translation();
  return error;
}

inline MadeScene made_scene(const MadeSceneOptions& o) {
  Random random(o.seed, "scene");
  MadeScene scene;
  pipeline::Reconstruction& truth = scene.truth;
  truth.frame = pipeline::ReconstructionFrame::metric;
  truth.lenses.push_back({o.camera});
  for (int row = 0; row < o.rows; ++row)
    for (int column = 0; column < o.columns; ++column) {
      Eigen::Vector3d centre = normal_vector(random, 1) + o.corner;
      centre += Eigen::Vector3d(column * o.base, row * o.base, 100);
      const Eigen::Vector3d turn = normal_vector(random, 0.02);
      const int side = (row + column) % 4;
      const double x = side == 0 ? o.tilt : side == 2 ? -o.tilt : 0;
      const double y = side == 1 ? o.tilt : side == 3 ? -o.tilt : 0;
      truth.images.push_back({.name = fmt::format("image_{:02}_{:02}", row, column),
                              .world_from_camera = looking_down(centre, x + turn.x(), y + turn.y())});
    }
  for (int i = 0; i < o.points; ++i) {
    const double x = random.uniform(-o.base, o.columns * o.base),
                 y = random.uniform(-o.base, o.rows * o.base);
    pipeline::TiePoint point;
    point.position = Eigen::Vector3d(x, y, ground(x, y, o.relief)) + o.corner;
    point.marks = marks_of(truth, *point.position, o.mark_sd, random);
    if (point.marks.size() >= 2) truth.points.push_back(point);
  }
  scene.start = truth;
  disturb(scene.start, random);
  return scene;
}

/// Returns positions of all cameras with Gaussian errors.
inline std::vector<pipeline::ObservedPosition> made_positions(const pipeline::Reconstruction& truth,
                                                              double sd, std::uint64_t seed) {
  Random random(seed, "positions");
  std::vector<pipeline::ObservedPosition> out;
  for (std::size_t i = 0; i < truth.images.size(); ++i)
    out.push_back({i, truth.images[i].world_from_camera->translation() + normal_vector(random, sd),
                   Eigen::Vector3d::Constant(sd)});
  return out;
}

/// Returns surveyed points over the ground, with marks in all images that see them and Gaussian errors.
inline std::vector<pipeline::ControlPoint> made_control(const MadeScene& scene, const MadeSceneOptions& o,
                                                        int columns, int rows, double sd) {
  Random random(o.seed, "control");
  std::vector<pipeline::ControlPoint> out;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double x = columns > 1 ? (o.columns - 1) * o.base * column / (columns - 1) : 0;
      const double y = rows > 1 ? (o.rows - 1) * o.base * row / (rows - 1) : 0;
      const Eigen::Vector3d at = Eigen::Vector3d(x, y, ground(x, y, o.relief)) + o.corner;
      pipeline::ControlPoint point{.name = fmt::format("P{}{}", row, column),
                                   .position = at + normal_vector(random, sd),
                                   .sd = Eigen::Vector3d::Constant(sd),
                                   .marks = marks_of(scene.truth, at, o.mark_sd, random)};
      out.push_back(point);
    }
  return out;
}

}  // namespace waymark::test
