// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/rim_profile.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace waymark::pipeline {

std::optional<RimHeights> rim_heights(const Terrain& terrain, const GroundOutline& outline) {
  constexpr int kFirstOutside = 7;  // 1.05 half axes
  const double s = std::sin(outline.orientation), c = std::cos(outline.orientation);
  RimHeights heights;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const auto direction = [](int azimuth) {
    const double t = 2 * std::numbers::pi * azimuth / kRimAzimuths;
    return Eigen::Vector2d(std::cos(t), std::sin(t));
  };
  for (int ring = 0; ring < kRimRings; ++ring)
    for (int azimuth = 0; azimuth < kRimAzimuths; ++azimuth) {
      const Eigen::Vector2d at = rim_ring(ring) * direction(azimuth);
      const double along = at.x() * outline.major / 2, across = at.y() * outline.minor / 2;
      const auto h = terrain.height(outline.centre.x() + along * s + across * c,
                                    outline.centre.y() + along * c - across * s);
      if (!h) return std::nullopt;
      heights(ring, azimuth) = *h;
      if (ring < kFirstOutside) continue;
      const Eigen::Vector3d row(1, at.x(), at.y());
      normal += row * row.transpose();
      right += row * *h;
    }
  const Eigen::Vector3d plane = normal.inverse() * right;
  for (int ring = 0; ring < kRimRings; ++ring)
    for (int azimuth = 0; azimuth < kRimAzimuths; ++azimuth)
      heights(ring, azimuth) -= plane[0] + plane.tail<2>().dot(rim_ring(ring) * direction(azimuth));
  return heights;
}

}  // namespace waymark::pipeline
