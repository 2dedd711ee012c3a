// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/units.hpp"
#include "geo/image_source.hpp"
#include "pipeline/craters/bowl_template.hpp"
#include "pipeline/craters/crater_candidate.hpp"
#include "pipeline/craters/shape_search.hpp"
namespace waymark::pipeline {

struct BowlSearch {
  Radians sun_angle;  ///< towards the sun, from x towards y
  CandidateLimits limits = {};
  /// Deep shadows are left out: they made no difference on real images.
  std::vector<BowlLight> lights{BowlLight::slope, BowlLight::low_shadow};
  /// Searched as well from 24 px on, where a level floor can be distinguished.
  std::vector<BowlLight> filled{BowlLight::flat_floor, BowlLight::rim_only};
};

/// Finds where shaded bowls correlate with the image: local maxima over position at seven sizes per octave,
/// best of the lights (BowlLight).
/// - Score: normalised correlation, lowered where the contrast is not above the image's noise.
/// - Several candidates per crater are normal; suppress_overlaps thins them.
/// - `image` has no NaN. Tiles run in parallel; the result does not depend on their order.
/// - Cost: overlap-save FFTs over an octave pyramid, about 0.17 s/Mpx on one core.
std::vector<CraterCandidate> bowl_candidates(const Pixels& image, const BowlSearch& search);

}  // namespace waymark::pipeline
