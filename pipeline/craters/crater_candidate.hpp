// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
namespace waymark {

/// A circle that may be a crater's rim. Pixels; (0, 0) is the centre of the first.
struct CraterCandidate {
  double x = 0, y = 0;
  double diameter = 0;
  double score = 0;  ///< higher is better; what it means is the maker's matter
  friend bool operator==(const CraterCandidate&, const CraterCandidate&) = default;
};

/// Area of the common part of two circles over the area they cover together, [0, 1].
double overlap(const CraterCandidate& a, const CraterCandidate& b);

/// Best first; equal scores by position and size, so that the order does not depend on how they were found.
void sort_by_score(std::vector<CraterCandidate>& candidates);

/// Two circles that cannot both be rims of different craters: they overlap by more than `most_overlap`, or
/// one lies centred (within a quarter of the smaller diameter) in another less than twice its size.
bool same_rim(const CraterCandidate& a, const CraterCandidate& b, double most_overlap);

/// Keeps the best of each group of the same rim, greedily from the best score down. Sorted by score.
/// O(n) for circles spread over the image: compared only within cells of their own octave of size and its
/// neighbours.
std::vector<CraterCandidate> suppress_overlaps(std::vector<CraterCandidate> candidates,
                                               double most_overlap = 0.25);

}  // namespace waymark
