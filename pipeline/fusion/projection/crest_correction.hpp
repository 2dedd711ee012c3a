// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/ground_outline.hpp"
namespace waymark::pipeline {

/// Distance of a crater's crest outside its outline in an image.
struct CrestCorrection {
  double growth = 0;     ///< ln(crest / outline), >= 0
  double growth_sd = 0;  ///< from the ambiguity of the heights and the scatter of the law
};

/// Estimates the crest of a degraded crater from the terrain; the crest lies outside the steepest change of
/// brightness (docs/methods/craters.md).
/// - Heights on 13 ellipses (median of 36 azimuths, minus the plane of the surroundings) are compared with
///   degradation_profiles.hpp of every depth.
/// - The growth is averaged over their likelihoods with a prior that favours deep craters, as images do.
/// - A terrain that does not resolve the crater is one of the hypotheses, with growth 0.
/// `std::nullopt` if the crater is narrower than three cells or heights around it are unknown.
std::optional<CrestCorrection> crest_correction(const Terrain& terrain, const GroundOutline& outline,
                                                double outline_edge_fraction);

}  // namespace waymark::pipeline
