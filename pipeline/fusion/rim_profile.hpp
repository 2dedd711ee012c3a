// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "geo/terrain.hpp"
#include "pipeline/fusion/ground_outline.hpp"
namespace waymark {

inline constexpr int kRimRings = 13, kRimAzimuths = 36;

/// Radius of a ring, in half axes of the outline: 0 to 1.8.
constexpr double rim_ring(int ring) {
  return 0.15 * ring;
}

/// Heights about a crater, metres: rows are rings, columns azimuths.
using RimHeights = Eigen::Matrix<double, kRimRings, kRimAzimuths>;

/// The terrain's heights on rings about the outline, less the plane through those from its edge on. Nothing
/// where one is not known.
std::optional<RimHeights> heights_about(const Terrain& terrain, const GroundOutline& outline);

}  // namespace waymark
