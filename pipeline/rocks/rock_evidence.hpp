// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

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
};

/// What speaks for and against a candidate, on comparable scales: size, depth and form of the shadow, and the
/// brightness before, on, beside and behind it. Rocks have a lit face towards the sun and plain ground behind
/// the shadow; hollows have it the other way round; dunes go on to the sides. `context`: what else is dark
/// about it.
inline constexpr std::size_t kEvidenceCount = 21;
using RockEvidence = std::array<double, kEvidenceCount>;
RockEvidence gather_evidence(const ShadowMap& map, const RockCandidate& candidate, const LightFrame& light,
                             const SpotContext& context);

/// Probability that the candidate is a rock: a network of one hidden layer fitted to drawn scenes
/// (docs/rocks.md, "Confidence").
double rock_confidence(const RockEvidence& evidence);

}  // namespace waymark
