// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "pipeline/craters/crater_candidate.hpp"
namespace waymark::test {
using namespace pipeline;

/// Criterion by which a detected and a true circle are the same crater.
enum class Match {
  overlap,   ///< common area over joint area >= 0.5
  deepmoon,  ///< squared distance < 1.8 and difference of radii < 1, in the smaller radius (Silburt et al.
             ///< 2019)
};

struct CircleScore {
  int hits = 0, false_alarms = 0, misses = 0;
  double precision = 0, recall = 0, f1 = 0;
  double centre = 0, size = 0, bias = 0;  ///< medians: centre error / D, |D / D' - 1|, D / D' - 1

  std::string text() const;
};

/// Matches one to one, greedily from the highest score down, each with the best fitting true circle. Counts
/// true circles of [smallest, largest) pixels; a match with a true one of another size is neither hit nor
/// false alarm.
CircleScore score_circles(std::vector<CraterCandidate> found, const std::vector<CraterCandidate>& truth,
                          double smallest, double largest = 1e9, Match match = Match::overlap);

/// Returns the expected calibration error of circles of `smallest` pixels and more: the mean over tenths of
/// probability of |mean score - fraction of true ones|, weighted by their number. Matches as score_circles().
double calibration_error(std::vector<CraterCandidate> found, const std::vector<CraterCandidate>& truth,
                         double smallest);

}  // namespace waymark::test
