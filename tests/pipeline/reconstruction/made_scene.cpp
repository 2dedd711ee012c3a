// SPDX-License-Identifier: Apache-2.0
#include "made_scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

#include "geo/camera.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;

/// Normal variables that are the same in every standard library (Box & Muller 1958).
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : random_(seed) {}
  double uniform() { return (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53; }
  double operator()(double sd) {
    return sd * std::sqrt(-2 * std::log(uniform())) * std::cos(2 * 3.14159265358979323846 * uniform());
  }
  Eigen::Vector3d vector(double sd) {
    const double x = (*this)(sd), y = (*this)(sd), z = (*this)(sd);
    return {x, y, z};
  }

 private:
  std::mt19937_64 random_;
};

double ground(double x, double y, double relief) {
  return relief * (std::sin(x / 13) * std::cos(y / 17) + 0.5 * std::sin((x + 2 * y) / 7));
}

Eigen::Isometry3d looking_down(const Eigen::Vector3d& centre, double about_x, double about_y) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()))
                      .toRotationMatrix() *
                  Eigen::Vector3d(1, -1, -1).asDiagonal();
  pose.translation() = centre;
  return pose;
}

std::vector<Mark> marks_of(const Reconstruction& truth, const Eigen::Vector3d& point, double sd,
                           Normal& normal) {
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < truth.images.size(); ++i) {
    const Camera& camera = truth.lenses[0].camera;
    const auto pixel = project(camera, {truth.images[i].world_from_camera->inverse() * point});
    if (!pixel || !((*pixel).minCoeff() > 0) || !(pixel->x() < static_cast<double>(camera.columns)) ||
        !(pixel->y() < static_cast<double>(camera.rows)))
      continue;
    const double u = normal(sd), v = normal(sd);
    marks.push_back({i, *pixel + Eigen::Vector2d(u, v), sd > 0 ? sd : 1});
  }
  return marks;
}

}  // namespace

MadeScene made_scene(const MadeSceneOptions& o) {
  Normal normal(o.seed);
  MadeScene scene;
  Reconstruction& truth = scene.truth;
  truth.frame = ReconstructionFrame::metric;
  truth.lenses.push_back({o.camera});
  for (int row = 0; row < o.rows; ++row)
    for (int column = 0; column < o.columns; ++column) {
      const Eigen::Vector3d centre(column * o.base + normal(1), row * o.base + normal(1), 100 + normal(2));
      const int side = (row + column) % 4;
      const double x = side == 0 ? o.tilt : side == 2 ? -o.tilt : 0;
      const double y = side == 1 ? o.tilt : side == 3 ? -o.tilt : 0;
      truth.images.push_back(
          {.name = fmt::format("image_{:02}_{:02}", row, column),
           .world_from_camera = looking_down(centre + o.corner, x + normal(0.02), y + normal(0.02))});
    }
  for (int i = 0; i < o.points; ++i) {
    const double x = (o.columns + 1) * o.base * normal.uniform() - o.base,
                 y = (o.rows + 1) * o.base * normal.uniform() - o.base;
    TiePoint point;
    point.position = Eigen::Vector3d(x, y, ground(x, y, o.relief)) + o.corner;
    point.marks = marks_of(truth, *point.position, o.mark_sd, normal);
    if (point.marks.size() >= 2) truth.points.push_back(point);
  }
  scene.start = truth;
  for (AdjustedImage& image : scene.start.images) {
    const Eigen::Vector3d turn = normal.vector(0.01);
    image.world_from_camera->linear() *= Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    image.world_from_camera->translation() += normal.vector(0.5);
  }
  for (TiePoint& point : scene.start.points) *point.position += normal.vector(0.5);
  return scene;
}

std::vector<ObservedPosition> made_positions(const Reconstruction& truth, double sd, std::uint64_t seed) {
  Normal normal(seed);
  std::vector<ObservedPosition> out;
  for (std::size_t i = 0; i < truth.images.size(); ++i)
    out.push_back({i, truth.images[i].world_from_camera->translation() + normal.vector(sd),
                   Eigen::Vector3d::Constant(sd)});
  return out;
}

std::vector<ControlPoint> made_control(const MadeScene& scene, const MadeSceneOptions& o, int columns,
                                       int rows, double sd) {
  Normal normal(o.seed + 1000);
  std::vector<ControlPoint> out;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double x = columns > 1 ? (o.columns - 1) * o.base * column / (columns - 1) : 0;
      const double y = rows > 1 ? (o.rows - 1) * o.base * row / (rows - 1) : 0;
      const Eigen::Vector3d at = Eigen::Vector3d(x, y, ground(x, y, o.relief)) + o.corner;
      ControlPoint point{.name = fmt::format("P{}{}", row, column),
                         .position = at + normal.vector(sd),
                         .sd = Eigen::Vector3d::Constant(sd),
                         .marks = marks_of(scene.truth, at, o.mark_sd, normal)};
      out.push_back(point);
    }
  return out;
}

}  // namespace waymark::test
