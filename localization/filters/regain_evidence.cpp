// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/regain_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "localization/filters/explained_fraction.hpp"

namespace waymark::localization {
namespace {

constexpr double kChanceKept = 1 - 1.0 / 100;  // of the chance matches, per set
constexpr double kChancePrior = 0.5;           // chance matches, and others, before any is known
constexpr double kMaxPoseShare = 10;           // of the variance of the pose, over that of the sighting

bool is_precise(const PoseEstimate& at, const SeenLandmark& s) {
  const double square = *s.range * *s.range;
  return at.covariance(0, 0) + at.covariance(1, 1) + square * at.covariance(2, 2) <=
         kMaxPoseShare * (s.range_sd * s.range_sd + square * s.bearing_sd * s.bearing_sd);
}

}  // namespace

double log_binomial_tail(int hits, int trials, double p) {
  if (hits <= 0 || p >= 1) return 0;
  if (hits > trials || !(p > 0)) return -std::numeric_limits<double>::infinity();
  const auto log_term = [&](int k) {
    return std::lgamma(trials + 1.0) - std::lgamma(k + 1.0) - std::lgamma(trials - k + 1.0) +
           k * std::log(p) + (trials - k) * std::log1p(-p);
  };
  double largest = log_term(hits);
  for (int k = hits + 1; k <= trials; ++k) largest = std::max(largest, log_term(k));
  double sum = 0;
  for (int k = hits; k <= trials; ++k) sum += std::exp(log_term(k) - largest);
  return std::min(0.0, largest + std::log(sum));
}

void RegainEvidence::add(const SightingSet& seen, std::span<const Match> matches, double chance,
                         const PoseEstimate& before, const PoseEstimate& after) {
  const auto objects = follower_.follow(seen);
  int compared = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!was_compared(matches[i])) continue;
    if (!seen.sightings[i].has_position()) {
      only_positions_ = only_positions_ && matches[i].verdict != Verdict::matched;
      continue;
    }
    if (!is_precise(before, seen.sightings[i]) || !is_precise(after, seen.sightings[i])) continue;
    ++compared;
    auto& landmark = objects_[objects[i].object];
    landmark.reset();
    if (matches[i].verdict == Verdict::matched) landmark = matches[i].key;
  }
  if (chance < 0 || compared == 0) return;
  by_chance_ = kChanceKept * by_chance_ + chance * compared;
  compared_ = kChanceKept * compared_ + compared;
}

double RegainEvidence::log_false_alarms(const PoseEstimate& at, const PoseEstimate& prior) const {
  std::set<LandmarkKey> landmarks;
  int twice = 0;
  for (const auto& [object, landmark] : objects_)
    if (landmark) twice += !landmarks.insert(*landmark).second;
  const double p = (by_chance_ + kChancePrior) / (compared_ + 2 * kChancePrior);
  const double one = at.covariance.determinant();
  if (!(one > 0)) return std::numeric_limits<double>::infinity();  // particles that agree to the last digit
  return std::max(0.0, 0.5 * std::log(prior.covariance.determinant() / one)) +
         log_binomial_tail(static_cast<int>(landmarks.size()), static_cast<int>(objects_.size()) - twice, p);
}

}  // namespace waymark::localization
