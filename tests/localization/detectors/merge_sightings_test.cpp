// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/merge_sightings.hpp"

#include <gmock/gmock.h>

#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

constexpr TypeId kTree = 0, kPole = 1;

SeenLandmark object_seen(TypeId type, double range, double bearing, double diameter) {
  SeenLandmark s = seen_at(range, bearing);
  s.type = type;
  s.features.value[type] = diameter;  // another place in each type
  return s;
}

SightingSet merged(std::vector<std::vector<SeenLandmark>> of_detectors) {
  std::vector<SightingSet> sets;
  for (auto& sightings : of_detectors) sets.push_back({{1, 0, 0}, std::move(sightings)});
  return merge_sightings(sets, {});
}

TEST(MergeSightings, OfOneObjectLeaveItsTypeOpen) {
  SeenLandmark tree = object_seen(kTree, 10, 0.2, 0.12), pole = object_seen(kPole, 10.1, 0.2, 0.1);
  tree.range_sd = 0.2;
  for (const bool swapped : {false, true}) {
    const SightingSet set = swapped ? merged({{pole}, {tree}}) : merged({{tree}, {pole}});
    EXPECT_EQ(set.robot_from_sensor.x, 1);
    ASSERT_EQ(set.sightings.size(), 1u);
    const SeenLandmark& s = set.sightings[0];
    EXPECT_FALSE(s.type);
    EXPECT_TRUE(s.may_be(kTree) && s.may_be(kPole));
    EXPECT_FALSE(s.may_be(2));
    EXPECT_EQ(s.features_as(kTree)->value[0], 0.12);
    EXPECT_EQ(s.features_as(kPole)->value[1], 0.1);
    EXPECT_EQ(s.features_as(2), nullptr);
    EXPECT_EQ(*s.range, 10) << "of the less certain one";
  }
}

TEST(MergeSightings, OfTwoObjectsAreTwo) {
  // 0.2 m between them; each detector finds both, or one of them finds the second one alone.
  const SeenLandmark first = object_seen(kTree, 10, 0.2, 0.12), second = object_seen(kTree, 10, 0.22, 0.12);
  const SeenLandmark pole = object_seen(kPole, 10, 0.2, 0.12), other = object_seen(kPole, 10, 0.22, 0.12);
  for (const auto& set :
       {merged({{first, second}, {other, pole}}), merged({{other, pole}, {first, second}})}) {
    ASSERT_EQ(set.sightings.size(), 2u);
    for (const SeenLandmark& s : set.sightings) EXPECT_EQ(types_of(s).size(), 2u);
  }
  const SightingSet one = merged({{first, second}, {other}});
  ASSERT_EQ(one.sightings.size(), 2u);
  EXPECT_EQ(one.sightings[0].type, kTree);
  EXPECT_FALSE(one.sightings[1].type);
  EXPECT_EQ(merged({{first, object_seen(kTree, 10.2, 0.2, 0.1)}}).sightings.size(), 2u) << "of one detector";
}

TEST(MergeSightings, OfOneTypeKeepIt) {
  const SeenLandmark s = object_seen(kTree, 10, 0.2, 0.12);
  const SightingSet set = merged({{s}, {s}});
  ASSERT_EQ(set.sightings.size(), 1u);
  EXPECT_EQ(set.sightings[0].type, kTree);
  EXPECT_TRUE(merged({}).sightings.empty());
  EXPECT_EQ(merged({{s}, {object_seen(kPole, 12, 0.2, 0.1)}}).sightings.size(), 2u) << "2 m behind it";
}

TEST(MergeSightings, OfAnythingMayBeAnything) {
  SeenLandmark untyped = object_seen(kTree, 10, 0.2, 0.12);
  untyped.type = {};
  const SightingSet set = merged({{untyped}, {object_seen(kPole, 10, 0.2, 0.1)}});
  ASSERT_EQ(set.sightings.size(), 1u);
  EXPECT_TRUE(set.sightings[0].may_be_anything());
}

TEST(SeenLandmark, TypesAreSharedIfOneFitsBoth) {
  const SeenLandmark tree = object_seen(kTree, 10, 0, 0.1), pole = object_seen(kPole, 10, 0, 0.1);
  const SeenLandmark either = merged({{tree}, {pole}}).sightings[0], anything = seen_at(10, 0);
  EXPECT_TRUE(may_share_type(tree, tree));
  EXPECT_FALSE(may_share_type(tree, pole));
  EXPECT_TRUE(may_share_type(tree, either) && may_share_type(either, pole) && may_share_type(either, either));
  EXPECT_TRUE(may_share_type(anything, anything));
  EXPECT_FALSE(may_share_type(anything, tree) || may_share_type(either, anything));
}

}  // namespace
}  // namespace waymark::test
