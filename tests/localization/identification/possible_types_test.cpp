// SPDX-License-Identifier: Apache-2.0
// Sightings whose type is open, and those of types that the map lacks.
#include "localization/identification/identification.hpp"

#include <gtest/gtest.h>

#include "localization/filters/sighting_score.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

// Of an object of a type that the map lacks, no fit is expected, so it is no sign of a wrong pose.
TEST(Identify, KnowsTheTypesThatTheMapHolds) {
  MapLandmark near = landmark_at(10, 0, 1), far = landmark_at(90, 0, 2);
  far.type = TypeId{2};
  const LandmarkGrid map({near, far});
  IdentificationOptions options{.held_types = {TypeId{0}, TypeId{2}}};
  const auto verdict = [&](TypeId type, std::optional<LandmarkKey> identity = {}) {
    SeenLandmark s = seen_at(10, 0);
    s.type = type, s.identity = identity;
    return identify({{}, {s}}, {}, map, {}, options).matches[0].verdict;
  };
  EXPECT_EQ(verdict(0), Verdict::matched);
  EXPECT_EQ(verdict(1), Verdict::unknown_type);
  EXPECT_EQ(verdict(2), Verdict::nothing_near);
  EXPECT_EQ(verdict(1, 1), Verdict::matched) << "its identity is known";
  options.held_types = {};
  EXPECT_EQ(verdict(1), Verdict::nothing_near) << "what the map holds is not known";
}

// What may be a pole of 0.1 m or a tree of 0.1 m is compared with each landmark as one of its type.
TEST(Identify, ComparesEachPossibleType) {
  constexpr TypeId kPole = 0, kTree = 1, kRock = 2;
  const auto of = [](double x, double y, LandmarkKey key, TypeId type, double diameter) {
    MapLandmark l = landmark_at(x, y, key);
    l.type = type, l.features.value[type] = diameter;  // another place in each type
    return l;
  };
  SeenLandmark s = seen_at(10, 0);
  for (const TypeId type : {kPole, kTree}) {
    KnownFeatures features;
    features.value[type] = 0.1, features.variance[type] = 1e-4;
    s.possible_types.push_back({type, features});
  }
  const auto match = [&](const MapLandmark& landmark) {
    const LandmarkGrid map({landmark, of(10.1, 0.1, 9, kRock, 0.1)});
    const Match found = identify({{}, {s}}, {}, map, {}, {.held_types = {kRock, landmark.type}}).matches[0];
    return found.verdict == Verdict::matched && map[found.pairing.landmark].key != landmark.key
               ? Verdict::taken
               : found.verdict;
  };
  EXPECT_EQ(match(of(10, 0, 1, kPole, 0.1)), Verdict::matched);
  EXPECT_EQ(match(of(10, 0, 1, kTree, 0.1)), Verdict::matched);
  EXPECT_EQ(match(of(10, 0, 1, kTree, 0.6)), Verdict::features_differ);
  EXPECT_EQ(match(of(10, 0, 1, kRock, 0.1)), Verdict::unknown_type) << "the map has neither";
}

// A possible type counts as the type itself.
TEST(SightingScore, OfAPossibleTypeIsThatOfTheType) {
  std::vector<MapLandmark> all = scatter_landmarks(60, 30, 5, 0.1);
  Random random(5, "types");
  for (MapLandmark& l : all)
    l.type = static_cast<TypeId>(random.uniform_index(3)), l.features.value[0] = random.uniform(0.5, 1);
  const LandmarkGrid map(all);
  const FeatureScales scales;
  SeenLandmark typed = seen_at(8, 0.3);
  typed.type = TypeId{1};
  typed.features.value[0] = 0.7, typed.features.variance[0] = 0.01;
  SeenLandmark possible = typed;
  possible.type = {}, possible.features = {};
  possible.possible_types = {{TypeId{1}, typed.features}};
  const WeightOptions options;
  const IdentificationOptions identification{.use_identities = false};
  const SightingSet typed_set{{}, {typed}}, possible_set{{}, {possible}};
  const SightingScore by_type(typed_set, map, scales, options, identification);
  const SightingScore by_possible(possible_set, map, scales, options, identification);
  for (int i = 0; i < 50; ++i) {
    const Pose2 robot{random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-3, 3)};
    EXPECT_EQ(by_type(robot), by_possible(robot));
  }
}

}  // namespace
}  // namespace waymark::test
