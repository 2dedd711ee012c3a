// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/clustering.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "core/random.hpp"
#include "tests/pipeline/fusion/made_objects.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

const MapPlane kPlane(Crs::local());

// The rule, literally: compare all pairs, merge the likeliest, repeat.
std::vector<std::uint32_t> cluster_by_definition(std::span<const ObservedObject> seen, const MapPlane& plane,
                                                 const AssociationRules& rules) {
  struct Thing {
    ObservedObject fused;
    std::vector<std::uint32_t> members;
  };
  std::vector<Thing> things;
  for (std::uint32_t i = 0; i < seen.size(); ++i) things.push_back({seen[i], {i}});
  const auto may_join = [&](const Thing& a, const Thing& b) {
    bool close = false;
    for (const auto i : a.members)
      for (const auto j : b.members) {
        if (seen[i].source == seen[j].source || seen[i].type != seen[j].type) return false;
        close = close || association_cost(seen[i], seen[j], plane, rules);
      }
    return close;
  };
  for (;;) {
    std::optional<double> best;
    std::size_t a = 0, b = 0;
    for (std::size_t i = 0; i < things.size(); ++i)
      for (std::size_t j = i + 1; j < things.size(); ++j) {
        if (!may_join(things[i], things[j])) continue;
        const auto cost = association_cost(things[i].fused, things[j].fused, plane, rules);
        if (cost && (!best || *cost < *best)) best = cost, a = i, b = j;
      }
    if (!best) break;
    things[a].fused = fuse(things[a].fused, things[b].fused, plane);
    things[a].members.insert(things[a].members.end(), things[b].members.begin(), things[b].members.end());
    things.erase(things.begin() + static_cast<std::ptrdiff_t>(b));
  }
  std::vector<std::uint32_t> label(seen.size());
  for (const Thing& thing : things)
    for (const auto i : thing.members)
      label[i] = *std::min_element(thing.members.begin(), thing.members.end());
  return label;
}

TEST(Cluster, MatchesTheDefinition) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const double spacing = seed % 3 == 0 ? 0.5 : seed % 3 == 1 ? 2 : 8;  // crowded, ambiguous, clear
    const auto seen = made_objects({.seed = seed, .things = 14, .images = 4, .spacing = spacing}).seen;
    ASSERT_EQ(cluster(seen, kPlane, {}), cluster_by_definition(seen, kPlane, {})) << "seed " << seed;
  }
}

TEST(Cluster, MatchesTheDefinitionInDegreesAcrossTheAntimeridian) {
  const Crs mars = Crs::from_text("+proj=longlat +R=3396190 +no_defs");
  const MapPlane plane(mars);
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    auto seen = made_objects({.seed = seed, .things = 14, .images = 4, .spacing = 3}).seen;
    for (ObservedObject& s : seen) {
      s.at = plane.translate({180, 71}, s.at);
      if (s.at.x() > 180) s.at.x() -= 360;
    }
    ASSERT_EQ(cluster(seen, plane, {}), cluster_by_definition(seen, plane, {})) << "seed " << seed;
  }
}

TEST(Cluster, NeverJoinsTwoOfOneImage) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto seen = made_objects({.seed = seed, .things = 200, .images = 5, .spacing = 0.7}).seen;
    const auto label = cluster(seen, kPlane, {});
    std::set<std::pair<std::uint32_t, std::uint32_t>> used;
    for (std::size_t i = 0; i < seen.size(); ++i)
      EXPECT_TRUE(used.emplace(label[i], seen[i].source).second) << "seed " << seed << ", sighting " << i;
  }
}

TEST(Cluster, DoesNotDependOnTheNumberOfThreads) {
  const auto seen = made_objects({.seed = 7, .things = 3000, .images = 6, .spacing = 1.5}).seen;
  const auto label = cluster(seen, kPlane, {});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(cluster(seen, kPlane, {}), label);
}

TEST(Cluster, FindsThingsThatStandApart) {
  const MadeObjects made = made_objects({.seed = 3, .things = 5000, .images = 6, .spacing = 12});
  const auto label = cluster(made.seen, kPlane, {});
  std::map<std::uint32_t, std::set<std::uint32_t>> truths, labels;  // of a label, of a truth
  for (std::size_t i = 0; i < label.size(); ++i)
    truths[label[i]].insert(made.thing[i]), labels[made.thing[i]].insert(label[i]);
  std::size_t mixed = 0, torn = 0;
  for (const auto& [_, set] : truths) mixed += set.size() > 1;
  for (const auto& [_, set] : labels) torn += set.size() > 1;
  EXPECT_EQ(mixed, 0u);
  EXPECT_LE(torn, 10u);  // two gates at 99.99 %, 20 000 joins: 4 expected
}

ObservedObject at(double x, double y, double sd, double radius, std::uint32_t source) {
  ObservedObject s;
  s.at = {x, y};
  s.covariance = Eigen::Matrix2d::Identity() * sd * sd;
  s.log_size = std::log(radius);
  s.log_size_variance = 0.01;
  s.source = source;
  return s;
}

TEST(Cluster, ChainsDoNotJoin) {
  // Each is within the gate of the previous one, but the ends are different things.
  std::vector<ObservedObject> seen;
  for (std::uint32_t i = 0; i < 9; ++i) seen.push_back(at(3.0 * i, 0, 1, 1, i));
  const auto label = cluster(seen, kPlane, {});
  const std::set<std::uint32_t> things(label.begin(), label.end());
  EXPECT_GE(things.size(), 4u);
  for (std::size_t i = 0; i < seen.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (label[i] == label[j]) {
        EXPECT_LE(seen[i].at.x() - seen[j].at.x(), 6.5);
      }
}

TEST(Cluster, VagueSightingDoesNotComeBetweenSharpOnes) {
  // A coarse image detects something near two rocks that two fine images separate.
  const std::vector<ObservedObject> seen{at(0, 0, 0.05, 0.5, 0), at(1.5, 0, 0.05, 0.5, 0),
                                         at(0.02, 0.03, 0.05, 0.5, 1), at(1.45, 0, 0.05, 0.5, 1),
                                         at(0.6, 0.1, 1.0, 0.7, 2)};
  EXPECT_EQ(cluster(seen, kPlane, {}), (std::vector<std::uint32_t>{0, 1, 0, 1, 0}));
}

TEST(Cluster, BodiesThatStandInEachOtherAreOneThoughCovariancesDeny) {
  const std::vector<ObservedObject> seen{at(0, 0, 0.01, 10, 0), at(3, 0, 0.01, 11, 1)};
  EXPECT_EQ(cluster(seen, kPlane, {}), (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(cluster(seen, kPlane, {.overlap = 0}), (std::vector<std::uint32_t>{0, 1}));
}

TEST(Cluster, TheCentreOfABodyIsInNoOther) {
  // Images disagree by more than their covariances, as where the ground differs from the DEM.
  const auto labels = [](double apart, double radius, std::uint32_t source) {
    return cluster(std::vector<ObservedObject>{at(0, 0, 0.01, 10, 0), at(apart, 0, 0.01, radius, source)},
                   kPlane, {});
  };
  const std::vector<std::uint32_t> one{0, 0}, two{0, 1};
  EXPECT_EQ(labels(9, 10, 1), one);
  EXPECT_EQ(labels(11, 10, 1), two);
  EXPECT_EQ(labels(9, 16, 1), two) << "not of like size";
  EXPECT_EQ(labels(9, 10, 0), two) << "of one image";
}

TEST(Cluster, SmallCraterInALargeOneIsAnother) {
  const std::vector<ObservedObject> seen{at(0, 0, 2, 50, 0), at(1, 0, 2, 12, 1)};
  EXPECT_EQ(cluster(seen, kPlane, {}), (std::vector<std::uint32_t>{0, 1}));
}

TEST(Cluster, NothingInNothingOut) {
  EXPECT_TRUE(cluster({}, kPlane, {}).empty());
}

TEST(ClosePairs, MatchComparingAll) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed, "close pairs");
    std::vector<Eigen::Vector3d> places;
    std::vector<double> reach;
    const bool flat = seed % 2 == 0;
    for (int i = 0; i < 200; ++i) {
      places.emplace_back(random.uniform(-50, 50), random.uniform(-50, 50), flat ? 0 : random.uniform(-9, 9));
      reach.push_back(i % 20 == 0 ? random.uniform(0, 30) : random.uniform(0, 2));
    }
    std::vector<IndexPair> expected;
    for (std::uint32_t i = 0; i < 200; ++i)
      for (std::uint32_t j = i + 1; j < 200; ++j)
        if ((places[i] - places[j]).norm() <= reach[i] + reach[j]) expected.push_back({i, j});
    ASSERT_EQ(find_neighbour_pairs(places, reach, [](auto, auto) { return true; }), expected)
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace waymark::test
