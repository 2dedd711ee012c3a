// SPDX-License-Identifier: Apache-2.0
// Suppression of repeated bowls against its slow twin.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"
#include "pipeline/craters/bowl_suppression.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

VerifiedBowl bowl(const CraterCandidate& circle, const CraterCandidate& corrected = {}) {
  return {.circle = circle, .corrected = corrected, .outline = {}, .centre_sd = 0, .diameter_sd = 0};
}

TEST(BowlSuppression, KeepsTwoOverlappingCratersIfBothAreSure) {
  const CraterCandidate old{50, 50, 40, 0.95}, young{74, 50, 30, 0.8};
  ASSERT_GT(overlap({50, 50, 40, 0}, {66, 50, 36, 0}), 0.225);
  EXPECT_EQ(suppress_repetitions({bowl(old), bowl(young)}).size(), 2U);
  CraterCandidate near{66, 50, 36, 0.8};
  EXPECT_EQ(suppress_repetitions({bowl(old), bowl(near)}).size(), 2U);
  near.score = 0.7;
  EXPECT_EQ(suppress_repetitions({bowl(old), bowl(near)}).size(), 1U);
}

TEST(BowlSuppression, CandidatesThatMoveToOneCircleAreOneCrater) {
  const CraterCandidate strong{50, 50, 40, 0.95}, weak{66, 50, 36, 0.9};
  EXPECT_EQ(suppress_repetitions({bowl(strong, {52, 50, 40, 0}), bowl(weak, {56, 50, 39, 0})}).size(), 1U);
  EXPECT_EQ(suppress_repetitions({bowl(strong, strong), bowl(weak, weak)}).size(), 2U);
}

TEST(BowlSuppression, AgreesWithTheComparisonOfAllPairs) {
  Random random(5, "bowls");
  for (int round = 0; round < 40; ++round) {
    std::vector<VerifiedBowl> bowls;
    for (int i = 0; i < 300; ++i) {
      const double d = random.log_uniform(8, 120);
      const CraterCandidate c{random.uniform(0, 400), random.uniform(0, 400), d, random.uniform(0.3, 1)};
      const CraterCandidate moved{c.x + random.normal() * 0.1 * d, c.y + random.normal() * 0.1 * d,
                                  d * random.uniform(0.8, 1.25), 0};
      bowls.push_back(bowl(c, random.bernoulli(0.8) ? moved : CraterCandidate{}));
      if (random.bernoulli(0.1)) bowls.push_back(bowls.back());  // ties
    }
    const RepetitionRules rules;
    std::vector<VerifiedBowl> sorted = bowls, kept;
    std::ranges::stable_sort(sorted, {}, [](const VerifiedBowl& b) {
      return std::tuple(-b.circle.score, b.circle.y, b.circle.x, b.circle.diameter);
    });
    for (const VerifiedBowl& b : sorted) {
      const bool repeated = std::ranges::any_of(kept, [&](const VerifiedBowl& k) {
        if (std::hypot(k.circle.x - b.circle.x, k.circle.y - b.circle.y) >=
            (k.circle.diameter + b.circle.diameter) / 2)
          return false;
        return same_rim(k.circle, b.circle, rules.same_overlap) ||
               overlap(k.corrected, b.corrected) > rules.same_corrected ||
               (b.circle.score < rules.sure && overlap(k.circle, b.circle) > rules.max_overlap);
      });
      if (!repeated) kept.push_back(b);
    }
    const auto fast = suppress_repetitions(bowls, rules);
    ASSERT_EQ(fast.size(), kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(fast[i].circle, kept[i].circle);
    std::ranges::reverse(bowls);
    const auto reversed = suppress_repetitions(bowls, rules);
    ASSERT_EQ(reversed.size(), kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(reversed[i].circle, kept[i].circle);
  }
}

}  // namespace
}  // namespace waymark::test
