// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/units.hpp"
#include "geo/image_source.hpp"
#include "pipeline/craters/bowl_template.hpp"
#include "pipeline/craters/crater_candidate.hpp"
namespace waymark {

struct BowlSearch {
  Radians sun_angle;                            ///< towards the sun, from x towards y
  double min_diameter = 8, max_diameter = 300;  ///< pixels
  double min_correlation = 0.45;                ///< of a candidate, (0, 1)
  /// Two do: the deepest shadows made no difference on real images.
  std::vector<BowlLight> lights{BowlLight::slope, BowlLight::low_shadow};
};

/// Where shaded bowls correlate with the image: the local maxima over position at each of seven sizes per
/// octave, of the best of the lights (see BowlLight). The score is the normalised correlation, lowered
/// where the contrast is not above the image's noise. Several candidates per crater: suppress_overlaps thins
/// them. `image` has no NaN. Overlap-save with FFTs over an octave pyramid (cost: about 0.17 s/Mpx on one
/// core); tiles run in parallel, the result does not depend on how.
std::vector<CraterCandidate> bowl_candidates(const Pixels& image, const BowlSearch& search);

}  // namespace waymark
