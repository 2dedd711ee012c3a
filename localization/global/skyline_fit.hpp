// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/global/horizon_viewpoint.hpp"
namespace waymark::localization {

/// Inputs of a fit beside the tops.
struct SkylineScene {
  const TerrainGrid& terrain;
  std::span<const SkylineSummit> summits;
  const SkylineOptions& options;
};

/// Fits the pose near a guess that is off by about `place` metres (iterated closest points with resection).
/// Each top is the nearest local maximum of the DEM's horizon, found by rays, or a summit in front of
/// higher terrain. The number of chance fits is computed for the final pose. `std::nullopt` if the tops do
/// not determine a pose near the guess.
std::optional<SkylineFix> fit_horizon(const SkylineScene& scene, std::span<const HorizonTop> tops,
                                      const HorizonGuess& guess, double place);

}  // namespace waymark::localization
