// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "geo/terrain.hpp"
#include "pipeline/fusion/ground_outline.hpp"
namespace waymark {

/// How far outside its outline in an image a crater's crest lies.
struct CrestByWear {
  double growth = 0;     ///< ln(crest / outline), >= 0
  double growth_sd = 0;  ///< of what the heights leave open, and of the law
};

/// A worn rim looks narrower than it is: its crest lies outside the place where brightness changes fastest,
/// the more so the more worn it is (docs/craters.md), and how worn it is is told by its depth. The terrain's
/// heights on 13 ellipses (median of 36 azimuths each, less the plane of the surroundings) are compared with
/// those of worn craters (worn_profiles.hpp) of every depth; what they leave open
/// is averaged over, deep craters before shallow ones, as images show them. That the terrain does not resolve
/// the crater is among what is averaged over: then nothing grows. Nothing where the crater is less than three
/// cells wide or the heights about it are not known.
std::optional<CrestByWear> crest_by_wear(const Terrain& terrain, const GroundOutline& outline,
                                         double edge_share);

}  // namespace waymark
