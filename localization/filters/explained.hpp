// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "localization/identification/identification.hpp"
#include "localization/identification/landmark_window.hpp"
namespace waymark {

/// Part of a set's sightings that have a landmark, of those that could have one; negative without any.
double fitting_share(const std::vector<Match>& matches);

/// The share that would fit by chance: what fits if a robot that knows its place as well stands elsewhere,
/// half to one range of its sensor away and turned. A new place at each call, the same ones in every run.
using ChanceShare = std::function<double(const SightingSet& seen, const PoseEstimate& at)>;
ChanceShare chance_share(LandmarkWindow map, FeatureScales scales, IdentificationOptions options);

/// How much of what is seen the map explains beyond chance. Of sightings of which the part q is on the map,
/// and the others fit with probability c, q + (1 - q) c fit; so q = (fit - c) / (1 - c). A dense map with
/// wide gates has c = 0.4, and a filter at a wrong place sees its sightings fit and is sure of it.
class Explained {
 public:
  void add(double fit, double chance);
  void clear() { sets_ = 0; }
  bool known() const { return sets_ >= 20; }
  double share() const { return (fit_ - chance_) / (1 - chance_ + 1e-9); }

 private:
  double fit_ = 0, chance_ = 0;
  int sets_ = 0;
};

}  // namespace waymark
