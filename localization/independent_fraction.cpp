// SPDX-License-Identifier: Apache-2.0
#include "localization/independent_fraction.hpp"

#include <algorithm>
#include <cmath>

#include "localization/filters/measurement.hpp"
#include "localization/identification/joint_evidence.hpp"

namespace waymark::localization {

namespace {

// ln of the factor on the sensor's noise is normal with mean 0 and this standard deviation.
constexpr double kNoiseLogSd = 0.35;

/// From half to twice.
double log_noise(std::size_t i) {
  return (static_cast<double>(i) - 2) / 2 * std::log(2);
}

SeenLandmark with_noise(SeenLandmark seen, double factor) {
  seen.range_sd *= factor, seen.bearing_sd *= factor;
  return seen;
}

}  // namespace

void IndependentFraction::learn(const SightingSet& seen, std::span<const Match> matches,
                                const PoseEstimate& before) {
  Grid<JointEvidence> evidence;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Match& match = matches[i];
    if (match.verdict != Verdict::matched || !seen.sightings[i].range || seen.sightings[i].extent ||
        !(match.covariance.trace() > 0) || !known_.insert(match.key).second)
      continue;
    const ExpectedSighting expected = expect(before.pose, seen.robot_from_sensor, match.at);
    for (std::size_t n = 0; n < evidence.size(); ++n) {
      const SeenLandmark noisy = with_noise(seen.sightings[i], std::exp(log_noise(n)));
      for (int k = 0; k <= kSteps; ++k)
        evidence[n][static_cast<std::size_t>(k)] +=
            evidence_of(noisy, expected, match.covariance * k / kSteps);
    }
  }
  if (!evidence[0][0].rows) return;
  for (std::size_t n = 0; n < evidence.size(); ++n)
    for (std::size_t k = 0; k <= kSteps; ++k) {
      const JointDistance distance = joint_distance(evidence[n][k], before.covariance);
      log_likelihood_[n][k] -= (distance.squares + distance.log_det) / 2;
    }
}

double IndependentFraction::mean() const {
  double max = -1e300, sum = 0, weighted = 0;
  const auto log_weight = [&](std::size_t n, std::size_t k) {
    const double noise = log_noise(n) / kNoiseLogSd;
    return log_likelihood_[n][k] - noise * noise / 2;
  };
  for (std::size_t n = 0; n < kNoises; ++n)
    for (std::size_t k = 0; k <= kSteps; ++k) max = std::max(max, log_weight(n, k));
  for (std::size_t n = 0; n < kNoises; ++n)
    for (std::size_t k = 0; k <= kSteps; ++k) {
      const double weight = std::exp(log_weight(n, k) - max);
      sum += weight, weighted += weight * static_cast<double>(k) / kSteps;
    }
  return std::clamp(weighted / sum, 1e-4, 1 - 1e-4);
}

}  // namespace waymark::localization
