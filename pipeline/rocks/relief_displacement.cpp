// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/relief_displacement.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "pipeline/rocks/shadow_shape.hpp"
namespace waymark::pipeline {
namespace {

constexpr double kMinDownward = 0.34;  // sine of 20 degrees
constexpr double kFarAway = 1000;      // metres; the result does not depend on the distance
constexpr double kStep = 0.1;          // metres

std::optional<Eigen::Vector2d> displacement_at(const PosedCamera& camera, const Eigen::Vector2d& pixel) {
  const auto line = ray(camera, pixel);
  if (!line || !(line->direction.unit.z() < -kMinDownward)) return std::nullopt;
  const Eigen::Vector3d foot = line->origin.xyz + kFarAway * line->direction.unit;
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

std::optional<ReliefDisplacement> relief_displacement_of(const PosedCamera& camera) {
  constexpr int kSide = 5;
  Eigen::Matrix<double, kSide * kSide, 3> places;
  Eigen::Matrix<double, kSide * kSide, 2> top_shift;
  const auto right = static_cast<double>(camera.camera.columns - 1),
             bottom = static_cast<double>(camera.camera.rows - 1);
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const Eigen::Vector2d pixel(right * i / (kSide - 1), bottom * j / (kSide - 1));
      const auto displacement = displacement_at(camera, pixel);
      if (!displacement) return std::nullopt;
      places.row(kSide * j + i) << 1, pixel.x(), pixel.y();
      top_shift.row(kSide * j + i) = displacement->transpose();
    }
  const Eigen::Matrix3d normal = places.transpose() * places;
  const Eigen::Matrix<double, 3, 2> fit = normal.inverse() * (places.transpose() * top_shift);
  if (!fit.allFinite()) return std::nullopt;  // an image of one row
  return ReliefDisplacement{fit.row(0).transpose(), fit.bottomRows<2>().transpose()};
}

VisibleShadow visible_shadow(const Eigen::Vector2d& displacement, const LightFrame& light,
                             double tan_elevation) {
  const double t = light.along(displacement.x(), displacement.y()),
               s = light.across(displacement.x(), displacement.y());
  return {.along = std::clamp(1 - t * tan_elevation, 0.3, 2.5),
          .deviation = std::min(2.5, std::abs(s) * tan_elevation),
          .displacement = displacement.norm()};
}

}  // namespace waymark::pipeline
