// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>

#include "pipeline/rocks/image_lean.hpp"
#include "pipeline/rocks/rock_table.hpp"
#include "pipeline/rocks/shadow_shape.hpp"
#include "pipeline/rocks/spot_context.hpp"
namespace waymark {

/// A shadow explained as a rock's.
struct RockCandidate {
  double x = 0, y = 0;  ///< middle of the rock, pixels
  ShadowShape shadow;
  RockSize size;
  std::size_t segment_cells = 0;
  double log_ratio_excess = 0;  ///< log(reach / radius), less what is usual under this sun
  SeenShadow seen;              ///< how the camera's slant changes the shadow
};

/// What speaks for and against a candidate, on comparable scales: size, depth and form of the shadow, and the
/// brightness before, on, beside and behind it. Rocks have a lit face towards the sun and plain ground behind
/// the shadow; hollows have it the other way round; dunes go on to the sides. `context`: what else is dark
/// about it. The last 45 are the shadow fractions of a net of 5 x 9 places about the shadow, as far apart as
/// the shadow's extents ask; of a place left of the light and its mirror the mean and the difference enter.
inline constexpr std::size_t kEvidenceCount = 21 + 6 + 3 + 45;
using RockEvidence = std::array<double, kEvidenceCount>;
RockEvidence gather_evidence(const ShadowMap& map, const RockCandidate& candidate, const LightFrame& light,
                             const SpotContext& context, const RockTable& table);

/// What the evidence says about a candidate, as logarithms of factors on the table's sizes and as ways in
/// units of `place_unit`.
struct RockJudgement {
  double confidence = 0;                 ///< probability that it is a rock
  double log_radius = 0, log_reach = 0;  ///< to be added to the logarithms of the table's sizes
  double along = 0;                      ///< away from the sun, to be added to the table's place
  double log_radius_sd = 0, log_reach_sd = 0, along_sd = 0, across_sd = 0;
};

/// A network of one hidden layer fitted to made scenes (docs/rocks.md, "Network").
RockJudgement judge_rock(const RockEvidence& evidence);

/// What places are told in, pixels: a pixel for small rocks, half the radius for large ones.
inline double place_unit(double radius) {
  return std::hypot(1.0, 0.5 * radius);
}

}  // namespace waymark
