// SPDX-License-Identifier: Apache-2.0
// Whether the matches of a filter that was lost are proof of its pose.
#include "localization/filters/regain_evidence.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace waymark::test {
using namespace localization;
namespace {

TEST(LogBinomialTail, IsTheSumOverAllOutcomes) {
  for (const double p : {0.003, 0.1, 0.5, 0.97})
    for (int trials = 0; trials <= 14; ++trials) {
      std::vector<double> probability(static_cast<std::size_t>(trials) + 1, 0);
      for (unsigned outcome = 0; outcome < 1U << trials; ++outcome) {
        const int hits = std::popcount(outcome);
        probability[static_cast<std::size_t>(hits)] += std::pow(p, hits) * std::pow(1 - p, trials - hits);
      }
      double tail = 0;
      for (int hits = trials; hits >= 0; --hits) {
        tail += probability[static_cast<std::size_t>(hits)];
        EXPECT_NEAR(log_binomial_tail(hits, trials, p), std::log(tail), 1e-9) << hits << " of " << trials;
      }
    }
  EXPECT_EQ(log_binomial_tail(3, 2, 0.1), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(log_binomial_tail(1, 5, 0), -std::numeric_limits<double>::infinity());
  EXPECT_LT(log_binomial_tail(400, 1000, 0.001), -1000);  // no underflow
}

PoseEstimate precise(double sd) {
  PoseEstimate e;
  e.covariance = Eigen::Vector3d(sd * sd, sd * sd, sd * sd / 100).asDiagonal();
  return e;
}

/// Sightings of objects far apart. The first `hits` are matched with landmarks of their own.
void add_set(RegainEvidence& evidence, int count, int hits, const PoseEstimate& at = precise(0.05),
             bool with_range = true, const std::optional<PoseEstimate>& after = {}) {
  SightingSet seen;
  std::vector<Match> matches;
  for (int i = 0; i < count; ++i) {
    SeenLandmark s;
    s.bearing = -1.5 + 3.0 * i / count;
    if (with_range) s.range = 10;
    s.range_sd = 0.1, s.bearing_sd = 0.01;
    seen.sightings.push_back(s);
    Match& match = matches.emplace_back();
    match.verdict = i < hits ? Verdict::matched : Verdict::too_far;
    match.key = static_cast<LandmarkKey>(i + 1);
  }
  evidence.add(seen, matches, 0.02, at, after.value_or(at));
}

TEST(RegainEvidence, DependsOnThePosesThatOdometryAllows) {
  RegainEvidence evidence;
  for (int set = 0; set < 20; ++set) add_set(evidence, 12, 4);
  const PoseEstimate here = precise(0.1);
  const double near = evidence.log_false_alarms(here, precise(0.2)),
               far = evidence.log_false_alarms(here, precise(20));
  EXPECT_LT(near, -4.6);  // four of twelve objects where odometry is precise
  EXPECT_GT(far, 0);      // of eight million poses some match as many
  EXPECT_NEAR(far - near, 3 * std::log(100), 1e-9);
  EXPECT_EQ(evidence.log_false_alarms(precise(0), precise(20)), std::numeric_limits<double>::infinity());
}

TEST(RegainEvidence, CountsAnObjectOnceHoweverOftenItIsSeen) {
  RegainEvidence once, often;
  for (int set = 0; set < 50; ++set) add_set(once, 12, 0), add_set(often, 12, 0);  // learn how rare chance is
  once.clear(), often.clear();
  add_set(once, 12, 4);
  for (int set = 0; set < 30; ++set) add_set(often, 12, 4);
  EXPECT_NEAR(once.log_false_alarms(precise(0.1), precise(1)),
              often.log_false_alarms(precise(0.1), precise(1)), 0.3);
}

TEST(RegainEvidence, MatchesOfAVaguePoseAreNone) {
  RegainEvidence evidence;
  for (int set = 0; set < 20; ++set) add_set(evidence, 12, 12, precise(3));
  EXPECT_GE(evidence.log_false_alarms(precise(0.1), precise(0.1)), 0);
}

// Particles that fit nothing spread out within a set. All that they match then is in the map by chance.
TEST(RegainEvidence, MatchesOfAFilterThatHasSpreadOutAreNone) {
  RegainEvidence evidence;
  for (int set = 0; set < 20; ++set) add_set(evidence, 12, 12, precise(0.05), true, precise(3));
  EXPECT_GE(evidence.log_false_alarms(precise(0.1), precise(0.1)), 0);
}

TEST(RegainEvidence, DoesNotJudgeBearings) {
  RegainEvidence evidence;
  add_set(evidence, 12, 0, precise(0.05), false);
  EXPECT_TRUE(evidence.is_possible());
  add_set(evidence, 12, 2, precise(0.05), false);
  EXPECT_FALSE(evidence.is_possible());
  evidence.clear();
  EXPECT_TRUE(evidence.is_possible());
}

}  // namespace
}  // namespace waymark::test
