// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "localization/identification/landmark_matcher.hpp"
namespace waymark::localization {

/// Returns whether a sighting was compared with landmarks of its type: it has one, or none fits.
bool was_compared(const Match& match);

/// Returns the fraction of a set's sightings with a landmark, among those that could have one. Negative if
/// there are none.
double matched_fraction(const std::vector<Match>& matches);

/// Returns the fraction of sightings that fits by chance: the fraction that fits at a wrong pose, half to
/// one sensor range away and rotated. Each call uses another pose; the sequence is the same in every run.
/// `matches`, those of the filter, say how many sightings are not of the map.
using ChanceFraction =
    std::function<double(const SightingSet& seen, const PoseEstimate& at, std::span<const Match> matches)>;
/// Returns that function for a map.
ChanceFraction make_chance_fraction(LandmarkMatcher matcher);

/// Fraction of the sightings that the map explains beyond chance. If the fraction q is of mapped landmarks
/// and others fit with probability c, q + (1 - q) c fit; so q = (fit - c) / (1 - c). A dense map with wide
/// gates has c = 0.4, where a filter at a wrong pose sees its sightings fit.
class ExplainedFraction {
 public:
  void add(double fit, double chance);
  void clear() { sets_ = 0; }
  bool known() const { return sets_ >= 20; }
  double value() const { return (fit_ - chance_) / (1 - chance_ + 1e-9); }

 private:
  double fit_ = 0, chance_ = 0;
  int sets_ = 0;
};

}  // namespace waymark::localization
