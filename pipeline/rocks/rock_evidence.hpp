// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>

#include "pipeline/rocks/relief_displacement.hpp"
#include "pipeline/rocks/rock_table.hpp"
#include "pipeline/rocks/shadow_shape.hpp"
#include "pipeline/rocks/spot_context.hpp"
namespace waymark::pipeline {

/// Shadow interpreted as that of a rock.
struct RockCandidate {
  double x = 0, y = 0;  ///< middle of the rock, pixels
  ShadowShape shadow;
  RockSize size;
  std::size_t catchment_cells = 0;
  double log_ratio_excess = 0;  ///< log(reach / radius) minus its mean under this sun
  VisibleShadow visible;        ///< effect of the oblique view on the shadow
};

/// Evidence for and against a candidate, on comparable scales: size, depth and form of the shadow, and the
/// brightness before, on, beside and behind it.
/// - Rocks have a lit face towards the sun and plain ground behind the shadow; hollows the reverse; dunes
///   continue to the sides.
/// - `context` describes other dark spots nearby.
/// - The last 45 values are shadow fractions on a grid of 5 x 9 points about the shadow, spaced by its
///   extents. Points left and right of the light enter as mean and difference.
inline constexpr std::size_t kEvidenceCount = 21 + 6 + 3 + 45;
using RockEvidence = std::array<double, kEvidenceCount>;
RockEvidence gather_evidence(const ShadowMap& map, const RockCandidate& candidate, const LightFrame& light,
                             const SpotContext& context, const RockTable& table);

/// Output of the network for a candidate: logarithms of factors on the sizes from the table, and offsets in
/// units of `position_unit`.
struct RockPrediction {
  double confidence = 0;                 ///< probability of being a rock
  double log_radius = 0, log_reach = 0;  ///< added to the logarithms of the sizes from the table
  double along = 0;                      ///< away from the sun, added to the position from the table
  double log_radius_sd = 0, log_reach_sd = 0, along_sd = 0, across_sd = 0;
};

/// Returns the unit of position offsets, pixels: one pixel for small rocks, half the radius for large ones.
inline double position_unit(double radius) {
  return std::hypot(1.0, 0.5 * radius);
}

}  // namespace waymark::pipeline
