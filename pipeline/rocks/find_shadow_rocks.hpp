// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "pipeline/rocks/find_rocks.hpp"
#include "pipeline/rocks/rock_evidence.hpp"
namespace waymark {

/// A candidate with what was gathered about it; the confidence is fitted on these.
struct JudgedRock {
  RockCandidate rock;
  RockEvidence evidence{};
  RockJudgement judgement{};      ///< of this candidate alone
  double confidence = 0;          ///< moved towards the image's share of rocks
  double noise = 0, texture = 0;  ///< standard deviations in alpha where it stands
  double scale = 1;               ///< side of its map's pixels, image pixels

  double radius() const;  ///< as judged, pixels of its scale
  /// Of the rock by the table, moved by what its lean hides of the shadow; the judgement is about this.
  Eigen::Vector2d place() const;
  Eigen::Vector2d aside = Eigen::Vector2d::Zero();  ///< that move, pixels of the scale
};

/// Every dark spot that could be a rock's shadow, at one scale: rocks up to about half a tile.
/// `lean`: of the image at this scale; nothing: seen from straight above.
std::vector<JudgedRock> judge_shadows(const ShadowMap& map, const LightFrame& light, const RockTable& table,
                                      const std::optional<ImageLean>& lean = {});

/// The same at every scale of the image, each half as fine as the one before, until `max_diameter` or the
/// size of the image; larger rocks are seen against a wider background. Positions are still those of each
/// scale. Confidences are moved towards the image's own share of rocks (share_shift).
std::vector<JudgedRock> judge_scales(const Pixels& image, const RockSearch& search, Radians sun_angle);

/// Direction towards the sun, given what estimate_sun_angle pooled, if anything: that, where under it at
/// least half as many rocks are found as under the best of twenty directions; else its opposite by the same
/// rule (hollows turn the pooled direction round); else the best. Looks at the middle 1000 x 1000 pixels.
/// Nothing where fewer than two rocks are probable under any direction.
std::optional<Radians> direction_with_rocks(const Pixels& image, const RockSearch& search,
                                            std::optional<Radians> pooled);

/// Method `shadow`: the light's direction is known.
std::vector<Detection> find_shadow_rocks(const Pixels& image, const RockSearch& search, Radians sun_angle);

}  // namespace waymark
