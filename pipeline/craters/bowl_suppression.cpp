// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/bowl_suppression.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pipeline/craters/kept_circles.hpp"

namespace waymark::pipeline {
namespace {

bool touch(const CraterCandidate& a, const CraterCandidate& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < (a.diameter + b.diameter) / 2;
}

bool are_one_crater(const VerifiedBowl& strong, const VerifiedBowl& weak, const RepetitionRules& rules) {
  if (!touch(strong.circle, weak.circle)) return false;
  if (same_rim(strong.circle, weak.circle, rules.same_overlap)) return true;
  if (overlap(strong.corrected, weak.corrected) > rules.same_corrected) return true;
  return weak.circle.score < rules.sure && overlap(strong.circle, weak.circle) > rules.max_overlap;
}

}  // namespace

std::vector<VerifiedBowl> suppress_repetitions(std::vector<VerifiedBowl> bowls,
                                               const RepetitionRules& rules) {
  std::ranges::sort(bowls, [](const VerifiedBowl& first, const VerifiedBowl& second) {
    const CraterCandidate &a = first.circle, &b = second.circle;
    return std::tie(b.score, a.y, a.x, a.diameter) < std::tie(a.score, b.y, b.x, b.diameter);
  });
  constexpr double kSmallestOverlap = 0.05;  // circles of other octaves are not compared
  KeptCircles index;
  std::vector<VerifiedBowl> kept;
  for (const VerifiedBowl& bowl : bowls) {
    const auto is_repeat = [&](const CraterCandidate&, std::size_t k) {
      return are_one_crater(kept[k], bowl, rules);
    };
    if (index.any_near(bowl.circle, kSmallestOverlap, is_repeat)) continue;
    index.add(bowl.circle, kept.size());
    kept.push_back(bowl);
  }
  return kept;
}

}  // namespace waymark::pipeline
