// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "pipeline/rocks/bright_side.hpp"
#include "pipeline/rocks/find_rocks.hpp"
#include "pipeline/rocks/rock_evidence.hpp"
namespace waymark::pipeline {

/// Rock candidate with its evidence, on which the confidence was fitted.
struct ScoredRock {
  RockCandidate rock;
  RockEvidence evidence{};
  RockPrediction prediction{};    ///< from this candidate alone
  double confidence = 0;          ///< adapted to the image's fraction of rocks
  double noise = 0, texture = 0;  ///< standard deviations in alpha at its position
  double scale = 1;               ///< pixel size of its map, image pixels
  double displacement_along = 0;  ///< relief displacement away from the sun, per unit of height
  BrightSide bright;              ///< of its surroundings; only known for candidates above 0.1

  double radius() const;  ///< after correction by the network, pixels of its scale
  /// Returns the position from the table, shifted by what relief displacement hides of the shadow; the
  /// prediction refers to it.
  Eigen::Vector2d position() const;
  Eigen::Vector2d lateral_shift = Eigen::Vector2d::Zero();  ///< that shift, pixels of the scale
};

/// Returns every dark spot that could be the shadow of a rock at one scale: rocks up to about half a tile.
/// `displacement`: relief displacement at this scale; unset: vertical view.
std::vector<ScoredRock> score_shadows(const ShadowMap& map, const LightFrame& light, const RockTable& table,
                                      const std::optional<ReliefDisplacement>& displacement = {});

/// Dark spots of all scales, and what of the image lies in shadow at its full resolution.
struct ScoredImage {
  std::vector<ScoredRock> spots;
  ShadedGround shaded;
};

/// Applies score_shadows at every scale of the image. Each is half as fine as the one before, until
/// `max_diameter` or the size of the image is reached; larger rocks are compared with a wider background.
/// Positions remain in pixels of each scale. Confidences are adapted to the fraction of rocks among the spots
/// of the same scale (prior_shift).
ScoredImage score_scales(const Pixels& image, const RockSearch& search, Radians sun_angle);

/// Finds rocks by the method `shadow` for a known direction of light, and checks whether they are lit from
/// it. Where too few are, confidences are lowered so that their sum is at most that of the rocks that can be
/// real.
RocksFound find_shadow_rocks(const Pixels& image, const RockSearch& search, Radians sun_angle);

}  // namespace waymark::pipeline
