// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/ground_outline.hpp"
namespace waymark::pipeline {

inline constexpr int kRimRings = 13, kRimAzimuths = 36;

/// Returns the radius of a ring, 0 to 1.8 semi-axes of the outline.
constexpr double rim_ring(int ring) {
  return 0.15 * ring;
}

/// Heights around a crater, metres: rows are rings, columns azimuths.
using RimHeights = Eigen::Matrix<double, kRimRings, kRimAzimuths>;

/// Returns the terrain's heights on rings around the outline, minus the plane through those outside it.
/// `std::nullopt` if a height is unknown.
std::optional<RimHeights> rim_heights(const Terrain& terrain, const GroundOutline& outline);

}  // namespace waymark::pipeline
