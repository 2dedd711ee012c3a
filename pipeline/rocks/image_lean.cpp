// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/image_lean.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
namespace waymark {
namespace {

constexpr double kLeastDown = 0.34;  // sine of 20 degrees
constexpr double kFarAway = 1000;    // metres: how far the ground is does not matter
constexpr double kStep = 0.1;        // metres

std::optional<Eigen::Vector2d> lean_at(const PosedCamera& camera, const Eigen::Vector2d& pixel) {
  const auto line = ray(camera, pixel);
  if (!line || !(line->along.unit.z() < -kLeastDown)) return std::nullopt;
  const Eigen::Vector3d foot = line->origin.xyz + kFarAway * line->along.unit;
  const auto step = [&](int axis) -> std::optional<Eigen::Vector2d> {
    const Eigen::Vector3d half = 0.5 * kStep * Eigen::Vector3d::Unit(axis);
    const auto from = project(camera, {foot - half}), to = project(camera, {foot + half});
    if (!from || !to) return std::nullopt;
    return *to - *from;
  };
  const auto east = step(0), north = step(1), up = step(2);
  if (!east || !north || !up) return std::nullopt;
  const double area = std::abs(east->x() * north->y() - east->y() * north->x());
  if (!(area > 0)) return std::nullopt;
  return *up / std::sqrt(area);
}

}  // namespace

std::optional<ImageLean> lean_of(const PosedCamera& camera) {
  constexpr int kSide = 5;
  Eigen::Matrix<double, kSide * kSide, 3> places;
  Eigen::Matrix<double, kSide * kSide, 2> leans;
  const auto right = static_cast<double>(camera.camera.columns - 1),
             bottom = static_cast<double>(camera.camera.rows - 1);
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const Eigen::Vector2d pixel(right * i / (kSide - 1), bottom * j / (kSide - 1));
      const auto lean = lean_at(camera, pixel);
      if (!lean) return std::nullopt;
      places.row(kSide * j + i) << 1, pixel.x(), pixel.y();
      leans.row(kSide * j + i) = lean->transpose();
    }
  const Eigen::Matrix3d normal = places.transpose() * places;
  const Eigen::Matrix<double, 3, 2> fit = normal.inverse() * (places.transpose() * leans);
  if (!fit.allFinite()) return std::nullopt;  // an image of one row
  return ImageLean{fit.row(0).transpose(), fit.bottomRows<2>().transpose()};
}

SeenShadow seen_shadow(const Eigen::Vector2d& lean, const LightFrame& light, double tan_elevation) {
  const double t = light.along(lean.x(), lean.y()), s = light.across(lean.x(), lean.y());
  return {.along = std::clamp(1 - t * tan_elevation, 0.3, 2.5),
          .aside = std::min(2.5, std::abs(s) * tan_elevation),
          .lean = lean.norm()};
}

}  // namespace waymark
