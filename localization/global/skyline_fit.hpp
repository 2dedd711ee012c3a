// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/global/horizon_place.hpp"
namespace waymark {

/// What a fit needs to know beside the tops.
struct SkylineScene {
  const TerrainGrid& terrain;
  std::span<const SkylineSummit> summits;
  const SkylineOptions& options;
};

/// The pose near a guess that is off by about `place` metres: each top is the local maximum of the DEM's
/// horizon nearest to it (rays), or a summit that stands free before higher ground; the pose is fitted to
/// these points (resection), and so again (iterated closest points). How many fit by chance is told for the
/// pose found. Nothing where the tops do not determine a pose near the guess.
std::optional<SkylineFix> fit_horizon(const SkylineScene& scene, std::span<const HorizonTop> tops,
                                      const HorizonGuess& guess, double place);

}  // namespace waymark
