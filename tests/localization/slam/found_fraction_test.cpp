// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/found_fraction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace waymark::test {
using namespace localization;
namespace {

using Set = std::vector<ExpectedLook>;

TEST(FoundFraction, OneLandmarkHiddenForLongIsOneMiss) {
  FoundFraction found;
  for (int i = 0; i < 100; ++i) found.add(Set{{0, false}, {1, true}});
  EXPECT_DOUBLE_EQ(found.value(0.5), (1 + 2 * 0.5) / 4);
}

TEST(FoundFraction, IsTheUsualOneWithoutLandmarks) {
  FoundFraction found;
  EXPECT_DOUBLE_EQ(found.value(0.7), 0.7);
  found.add(Set{{0, false}, {1, false}, {2, false}, {3, false}, {4, false}, {5, false}});
  EXPECT_DOUBLE_EQ(found.value(0.8), 0.2);
  for (int i = 0; i < 30; ++i) found.add({});
  EXPECT_DOUBLE_EQ(found.value(0.8), 0.8);
}

TEST(FoundFraction, AConfirmedPoseHasTheUsualOneWhateverHidesTheLandmarks) {
  FoundFraction found;
  const Set hidden{{0, false}, {1, false}, {2, false}};
  for (int i = 0; i < 50; ++i) found.add(hidden);
  found.raise_to(0.6);
  EXPECT_DOUBLE_EQ(found.value(0.6), 0.6);
  found.add(hidden);
  EXPECT_GT(found.value(0.6), 0.5 * 0.6);
}

/// Keeps all sets and counts again.
double by_definition(const std::vector<Set>& sets, double usual) {
  double found = 2 * usual, weight = 2;
  for (std::size_t landmark = 0; landmark < 5; ++landmark) {
    double mean = 0, since = 100;
    int looks = 0;
    for (const Set& set : sets) {
      ++since;
      for (const ExpectedLook& look : set) {
        if (look.landmark != landmark) continue;
        if (since > 22) mean = 0, looks = 0;  // 22 sets passed without a look: 0.9^22 < 0.1
        ++looks, since = 0;
        mean = looks <= 10 ? (mean * (looks - 1) + look.is_found) / looks : 0.9 * mean + 0.1 * look.is_found;
      }
    }
    if (since > 21) continue;
    found += std::pow(0.9, since) * mean, weight += std::pow(0.9, since);
  }
  return found / weight;
}

TEST(FoundFraction, MatchesItsDefinition) {
  std::mt19937 random(1);
  FoundFraction found;
  std::vector<Set> sets;
  double rate = 0;
  for (int i = 0; i < 600; ++i) {
    if (i % 50 == 0) rate = std::uniform_real_distribution(0.0, 0.3)(random);
    Set set;
    for (std::size_t landmark = 0; landmark < 5; ++landmark)
      if (std::bernoulli_distribution(rate)(random))
        set.push_back({landmark, std::bernoulli_distribution(0.7)(random)});
    found.add(set);
    sets.push_back(set);
    ASSERT_NEAR(found.value(0.6), by_definition(sets, 0.6), 1e-12) << "set " << i;
  }
}

}  // namespace
}  // namespace waymark::test
