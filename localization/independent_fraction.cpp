// SPDX-License-Identifier: Apache-2.0
#include "localization/independent_fraction.hpp"

#include <algorithm>
#include <cmath>

#include "localization/filters/measurement.hpp"
#include "localization/identification/joint_evidence.hpp"

namespace waymark::localization {

void IndependentFraction::learn(const SightingSet& seen, std::span<const Match> matches,
                                const PoseEstimate& before) {
  std::array<JointEvidence, kSteps + 1> evidence;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Match& match = matches[i];
    if (match.verdict != Verdict::matched || !seen.sightings[i].range || !(match.covariance.trace() > 0) ||
        !known_.insert(match.key).second)
      continue;
    const ExpectedSighting expected = expect(before.pose, seen.robot_from_sensor, match.at);
    for (int k = 0; k <= kSteps; ++k)
      evidence[static_cast<std::size_t>(k)] +=
          evidence_of(seen.sightings[i], expected, match.covariance * k / kSteps);
  }
  if (!evidence[0].rows) return;
  for (std::size_t k = 0; k < evidence.size(); ++k) {
    const JointDistance distance = joint_distance(evidence[k], before.covariance);
    log_likelihood_[k] -= (distance.squares + distance.log_det) / 2;
  }
}

double IndependentFraction::mean() const {
  const double max = *std::ranges::max_element(log_likelihood_);
  double sum = 0, weighted = 0;
  for (int k = 0; k <= kSteps; ++k) {
    const double weight = std::exp(log_likelihood_[static_cast<std::size_t>(k)] - max);
    sum += weight, weighted += weight * k / kSteps;
  }
  return std::clamp(weighted / sum, 1e-4, 1 - 1e-4);
}

}  // namespace waymark::localization
