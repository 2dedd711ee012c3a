// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <unordered_set>
#include "localization/identification/identification.hpp"
namespace waymark::localization {

/// Estimates which fraction of the variance that a map states for its landmarks is independent between them.
/// The rest is a shift that neighbours share, which leaves no difference between what is seen and the map.
/// - Likelihood of the innovations of each landmark's first sighting, on a grid of fractions.
///   Later sightings repeat the error of the landmark.
/// - The sensor's noise may be half to twice as large as stated, so that only errors of the map larger than
///   it decide.
class IndependentFraction {
 public:
  /// Learns from a set's sightings with a range. `before`: pose relative to landmarks before the update.
  void learn(const SightingSet& seen, std::span<const Match> matches, const PoseEstimate& before);
  /// Returns the mean of the fraction, in (0, 1); 0.5 before any sighting.
  double mean() const;

 private:
  static constexpr int kSteps = 10, kNoises = 5;
  template <class Value>
  using Grid = std::array<std::array<Value, kSteps + 1>, kNoises>;  // by noise; fractions from 0 to 1

  Grid<double> log_likelihood_{};
  std::unordered_set<LandmarkKey> known_;
};

}  // namespace waymark::localization
