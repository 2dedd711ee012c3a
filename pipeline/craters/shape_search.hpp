// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "geo/image_source.hpp"
#include "pipeline/craters/crater_candidate.hpp"
namespace waymark {

/// How something looks in a grid, for one of a row of sizes.
struct ShapeSearch {
  double min_diameter = 8, max_diameter = 300;  ///< pixels
  double min_correlation = 0.45;                ///< of a candidate, (0, 1)
  /// The looks of a thing of a diameter of 8 to 16 px: odd squares of one size, zero mean, norm 1.
  std::function<std::vector<Pixels>(double diameter)> shapes;
  /// The grid less its mean over this many pixels of each level's own is searched; 0: the grid itself.
  double level_mean = 0;
};

/// Where one of the shapes correlates with the grid: the local maxima over position at each of seven sizes
/// per octave. The score is the best normalised correlation, lowered where the contrast is not above the
/// noise. Several candidates per thing: suppress_overlaps thins them. `image` has no NaN. Overlap-save with
/// FFTs over an octave pyramid; tiles run in parallel, the result does not depend on how.
std::vector<CraterCandidate> shape_candidates(const Pixels& image, const ShapeSearch& search);

}  // namespace waymark
