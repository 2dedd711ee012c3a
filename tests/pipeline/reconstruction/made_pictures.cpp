// SPDX-License-Identifier: Apache-2.0
#include "made_pictures.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "testbed/noise.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
namespace {

// Marches along the ray: the relief is gentle.
std::optional<Eigen::Vector2d> ground_point(const MadeGround& ground, const Eigen::Vector3d& from,
                                            const Eigen::Vector3d& along) {
  if (!(along.z() < -0.02)) return std::nullopt;
  double range = from.z() / -along.z();
  for (int i = 0; i < 5 && ground.relief > 0; ++i) {
    const Eigen::Vector3d at = from + range * along;
    range += (at.z() - ground.height(at.x(), at.y())) / -along.z();
  }
  return (from + range * along).head<2>();
}

}  // namespace

double MadeGround::height(double x, double y) const {
  if (relief == 0) return 0;
  return relief * testbed::gradient_noise_value(x / longest, y / longest, seed + 77);
}

double MadeGround::brightness(double x, double y) const {
  double value = 0, total = 0;
  std::uint32_t octave = 0;
  for (double length = longest; length > shortest; length /= 2, ++octave) {
    const double c = std::cos(octave), s = std::sin(octave);
    value += testbed::gradient_noise_value((c * x - s * y) / length, (s * x + c * y) / length, seed + octave);
    total += 1;
  }
  return 128 + 50 * value / std::sqrt(total);
}

Pixels made_picture(const MadeGround& ground, const PosedCamera& view) {
  Pixels out(view.camera.columns, view.camera.rows);
  MadeGround shown = ground;  // nothing finer than the pixels show
  const double gsd = view.centre().xyz.z() / view.camera.fx;
  shown.shortest = std::max(ground.shortest, 2.5 * gsd);
  tbb::parallel_for(std::int64_t{0}, out.rows(), [&](std::int64_t r) {
    for (std::int64_t c = 0; c < out.columns(); ++c) {
      const auto along = ray(view, {double(c), double(r)});
      const auto at = along ? ground_point(ground, along->origin.xyz, along->direction.unit) : std::nullopt;
      out(c, r) =
          at ? static_cast<float>(std::round(std::clamp(shown.brightness(at->x(), at->y()), 1.0, 255.0)))
             : std::nanf("");
    }
  });
  return out;
}

Camera made_camera(std::int64_t columns, std::int64_t rows, double field_of_view) {
  const double f = double(columns) / 2 / std::tan(field_of_view * kDegree / 2);
  return {.columns = columns,
          .rows = rows,
          .fx = f,
          .fy = f,
          .cx = double(columns - 1) / 2,
          .cy = double(rows - 1) / 2};
}

PosedCamera made_view(const Camera& camera, const Eigen::Vector3d& position, double tilt, double heading,
                      double turn) {
  Eigen::Matrix3d down;
  down << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // looks straight down, upper edge to the north
  PosedCamera view{.camera = camera, .grid_from_camera = {}};
  view.grid_from_camera.transform.linear() =
      Eigen::AngleAxisd(-heading * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix() * down *
      Eigen::AngleAxisd(tilt * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix() *
      Eigen::AngleAxisd(turn * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  view.grid_from_camera.transform.translation() = position;
  return view;
}

}  // namespace waymark::test
