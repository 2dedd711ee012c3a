// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
namespace waymark::pipeline {

/// Circle that may be a crater rim. Pixels; (0, 0) is the centre of the first pixel.
struct CraterCandidate {
  double x = 0, y = 0;
  double diameter = 0;
  double score = 0;  ///< higher is better; its scale depends on the detector
  friend bool operator==(const CraterCandidate&, const CraterCandidate&) = default;
};

/// Returns the intersection over union of two circles, [0, 1].
double overlap(const CraterCandidate& a, const CraterCandidate& b);

/// Sorts by descending score; ties by position and size, so that the order does not depend on the input
/// order.
void sort_by_score(std::vector<CraterCandidate>& candidates);

/// Returns whether two circles cannot be rims of different craters:
/// - their intersection over union exceeds `max_overlap`, or
/// - one is centred (within a quarter of the smaller diameter) in another less than twice its size.
bool same_rim(const CraterCandidate& a, const CraterCandidate& b, double max_overlap);

/// Keeps the best of each group with the same rim, greedily from the best score down. Returns them sorted
/// by score. O(n) for circles spread over the image: only cells of the same octave of size and its
/// neighbours are compared.
std::vector<CraterCandidate> suppress_overlaps(std::vector<CraterCandidate> candidates,
                                               double max_overlap = 0.25);

}  // namespace waymark::pipeline
