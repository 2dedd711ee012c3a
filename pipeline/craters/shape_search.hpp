// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "geo/image_source.hpp"
#include "pipeline/craters/crater_candidate.hpp"
namespace waymark::pipeline {

/// Which candidates are searched.
struct CandidateLimits {
  double min_diameter = 8, max_diameter = 300;  ///< pixels
  double min_correlation = 0.45;                ///< of a candidate, (0, 1)
};

/// Templates to correlate with a grid over a range of sizes.
struct ShapeSearch {
  CandidateLimits limits = {};
  /// Returns the templates for a diameter of 8 to 16 px: odd squares of equal size, zero mean, unit norm.
  std::function<std::vector<Pixels>(double diameter)> shapes;
  /// Templates for diameters of 24 px and more, as `shapes`; empty: the same.
  std::function<std::vector<Pixels>(double diameter)> large_shapes = {};
  /// A Gaussian mean of this standard deviation, pixels of each pyramid level, is subtracted first; 0:
  /// none.
  double level_mean = 0;
};

/// Finds where a template correlates with the grid: local maxima over position at seven sizes per octave.
/// - Score: best normalised correlation, lowered where the contrast is not above the noise.
/// - Several candidates per object are normal; suppress_overlaps thins them.
/// - `image` has no NaN. Overlap-save FFTs over an octave pyramid; tiles run in parallel, the result does
///   not depend on their order.
std::vector<CraterCandidate> shape_candidates(const Pixels& image, const ShapeSearch& search);

}  // namespace waymark::pipeline
