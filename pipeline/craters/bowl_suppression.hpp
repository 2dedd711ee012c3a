// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/craters/bowl_verification.hpp"
namespace waymark::pipeline {

/// When two verified bowls are one crater.
struct RepetitionRules {
  double max_overlap = 0.225;   ///< intersection over union of two rims above which the weaker must be sure
  double sure = 0.75;           ///< probability from which such a bowl is kept; above 1: never
  double same_overlap = 0.5;    ///< intersection over union above which two rims are one, however sure
  double same_corrected = 0.4;  ///< same of the circles to which the model moved the two candidates
};

/// Keeps the best of each group of bowls that show the same crater, greedily from the best score down.
/// Craters that overlap are both kept if the model moves their candidates to different circles and both are
/// sure. Returns them sorted by score. Cost as suppress_overlaps().
std::vector<VerifiedBowl> suppress_repetitions(std::vector<VerifiedBowl> bowls,
                                               const RepetitionRules& rules = {});

}  // namespace waymark::pipeline
