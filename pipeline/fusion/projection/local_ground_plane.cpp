// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/local_ground_plane.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <vector>

namespace waymark::pipeline {

std::optional<GroundPlane> fit_plane(std::span<const Eigen::Vector3d> points) {
  if (points.size() < 3) return std::nullopt;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  Eigen::Vector2d rise = Eigen::Vector2d::Zero();
  for (const auto& p : points) {
    const Eigen::Vector3d d = p - mean;
    moments += d.head<2>() * d.head<2>().transpose();
    rise += d.head<2>() * d.z();
  }
  const double spread = moments.trace();
  if (!(moments.determinant() > 1e-6 * spread * spread)) return std::nullopt;
  return GroundPlane{mean, moments.inverse() * rise};
}

std::optional<GroundPlane> local_ground_plane(const Terrain& terrain, double x, double y, double radius) {
  const auto here = terrain.height(x, y);
  if (!here) return std::nullopt;
  const double r = std::max({radius, terrain.step_x(), terrain.step_y()});
  std::vector<Eigen::Vector3d> known{{x, y, *here}};
  for (int k = 0; k < 8; ++k) {
    const double t = std::numbers::pi * k / 4;
    const double at_x = x + r * std::cos(t), at_y = y + r * std::sin(t);
    if (const auto z = terrain.height(at_x, at_y)) known.emplace_back(at_x, at_y, *z);
  }
  GroundPlane plane{{x, y, *here}, Eigen::Vector2d::Zero()};
  if (const auto through = fit_plane(known)) plane.gradient = through->gradient;
  return plane;
}

}  // namespace waymark::pipeline
