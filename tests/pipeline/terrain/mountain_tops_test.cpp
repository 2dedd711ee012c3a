// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/mountain_tops.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "tests/pipeline/terrain/survey.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

const TypeRegistry& types() {
  static const TypeRegistry all = [] {
    TypeRegistry registry;
    register_landmark_types(registry);
    return registry;
  }();
  return all;
}

MountainTops tops_in(const DemSource& dem, const Window& window, const MountainTopOptions& options = {}) {
  auto summits = survey(dem, 64);
  std::ranges::sort(summits, {}, &Summit::cell);
  std::vector<HighPoint> points;
  for (const Summit& s : summits) points.push_back({s.cell, s.height});
  return mountain_tops(summits, measure_isolation(points, dem, pyramid_of(dem, 64), {}), dem, types(),
                       options, window);
}

std::vector<Landmark> tops_of(const DemSource& dem, const MountainTopOptions& options = {}) {
  return tops_in(dem, {0, 0, dem.geometry().columns, dem.geometry().rows}, options).landmarks;
}

double feature(const Landmark& l, std::string_view name) {
  return l.features.at(feature_index(types()[l.type], name)).value;
}
AttributeValue attribute(const Landmark& l, std::string_view name) {
  return l.attributes.at(attribute_index(types()[l.type], name));
}

// Three summits in a row on a 30 m grid in UTM: 9, then 5 beside 7.
const MemoryDem kThree(dem_art("0 0 0 0 0 0 0 0 / 0 9 2 5 4 7 0 0 / 0 0 0 0 0 0 0 0"),
                       {Crs::from_text("EPSG:32632"), 500000, 5000000, 30, -30});

TEST(MountainTops, CarryFeaturesAndWhereTheyComeFrom) {
  const auto tops = tops_of(kThree);
  ASSERT_EQ(tops.size(), 3u);  // in row order: 9, 5, 7
  const Landmark &nine = tops[0], &five = tops[1], &seven = tops[2];
  EXPECT_TRUE(nine.position.xyz.isApprox(Eigen::Vector3d(500030, 4999970, 9)));
  EXPECT_EQ(feature(nine, "prominence"), 9);
  EXPECT_FALSE(nine.features[feature_index(types()[nine.type], "isolation")].known());
  EXPECT_EQ(attribute(nine, "saddle_elevation"), AttributeValue{});
  EXPECT_EQ(attribute(nine, "parent_uid"), AttributeValue{});
  EXPECT_EQ(feature(five, "prominence"), 1);
  EXPECT_EQ(attribute(five, "saddle_x"), AttributeValue{500120.0});
  EXPECT_EQ(attribute(five, "parent_uid"), AttributeValue{seven.uid});
  EXPECT_EQ(attribute(seven, "parent_uid"), AttributeValue{nine.uid});
  EXPECT_NEAR(feature(seven, "isolation"), 120, 0.1);  // 4 cells; UTM metres are 0.9996 of ground metres here
  EXPECT_EQ(attribute(seven, "higher_x"), AttributeValue{500030.0});
}

TEST(MountainTops, WhoseParentIsLeftOutNameTheGrandparent) {
  EXPECT_EQ(tops_of(kThree, {.min_isolation = Meters{59}}).size(), 3u);  // the nearest two are 60 m apart
  // The parent of the far hill of 5 would be the shoulder of 8, which is left out.
  const MemoryDem dem(dem_art("0 0 0 0 0 0 0 0 0 0 0 / 0 9 7 8 2 2 2 2 2 5 0 / 0 0 0 0 0 0 0 0 0 0 0"),
                      kThree.geometry().where);
  const auto far = tops_of(dem, {.min_isolation = Meters{100}});
  ASSERT_EQ(far.size(), 2u);
  EXPECT_EQ(attribute(far[1], "parent_uid"), AttributeValue{far[0].uid});
}

TEST(MountainTops, OfTilesAreThoseOfTheGrid) {
  for (const double cell : {30.0, 0.004}) {  // the second: several cells share a uid's centimetre
    const MemoryDem dem(random_terrain(5, 60, 45),
                        {Crs::from_text("EPSG:32632"), 500000, 5000000, cell, -cell});
    const auto whole = tops_of(dem, {.min_isolation = Meters{2 * cell}});
    std::map<std::string, AttributeValue> parents;
    std::size_t count = 0;
    for (const Window& tile : tiles_of(dem.geometry(), 16))
      for (const Landmark& top : tops_in(dem, tile, {.min_isolation = Meters{2 * cell}}).landmarks) {
        parents[top.uid] = attribute(top, "parent_uid");
        ++count;
      }
    ASSERT_EQ(count, whole.size());
    ASSERT_EQ(parents.size(), whole.size()) << "uids are unique";
    for (const Landmark& top : whole) EXPECT_EQ(parents.at(top.uid), attribute(top, "parent_uid"));
  }
}

TEST(MountainTops, BeyondTheRangeOfTheTypeAreCountedAndLeftOut) {
  const MemoryDem deep(dem_art("-25000 -25000 -25000 / -25000 -20000 -25000 / -25000 -25000 -25000"),
                       kThree.geometry().where);
  auto summits = survey(deep, 64, 0, BasePolicy::lowest);
  ASSERT_EQ(summits.size(), 1u);
  const auto tops = mountain_tops(summits, std::vector<Isolation>(1), deep, types(), {}, {0, 0, 3, 3});
  EXPECT_TRUE(tops.landmarks.empty());
  EXPECT_EQ(tops.rejected.at("elevation outside the range of the type"), 1);
}

TEST(MountainTops, KnowHowMuchOfTheirProminenceIsCertain) {
  const MemoryDem dem(dem_art("0 0 0 0 0 0 / 0 9 3 7 5 4 / 0 0 0 0 0 0"), kThree.geometry().where);
  const auto tops = tops_of(dem);
  EXPECT_EQ(attribute(tops[1], "prominence_low"), AttributeValue{3.0});
  EXPECT_DOUBLE_EQ(tops[1].confidence, 0.75);
}

TEST(MountainTops, HaveTheVarianceOfTheirCell) {
  const auto utm = tops_of(kThree);
  EXPECT_NEAR(utm[0].covariance(0, 0), 75, 1e-9);    // 30^2 / 12
  EXPECT_TRUE(std::isnan(utm[0].covariance(2, 2)));  // the DEM does not state it: unknown, not 0
  const MemoryDem degrees(kThree.heights(), {Crs::from_text("EPSG:4326"), 8, 60, 0.01, -0.01});
  const auto north = tops_of(degrees);
  EXPECT_NEAR(std::sqrt(12 * north[0].covariance(0, 0)), 556, 3);  // 0.01 degrees at 60 north
  EXPECT_NEAR(std::sqrt(12 * north[0].covariance(1, 1)), 1112, 3);
}

TEST(MountainTops, HaveNamesThatDoNotDependOnTheOthers) {
  const auto all = tops_of(kThree);
  const auto some = tops_of(kThree, {.min_isolation = Meters{100}});
  ASSERT_EQ(some.size(), 2u);
  EXPECT_EQ(some[0].uid, all[0].uid);
  EXPECT_EQ(some[1].uid, all[2].uid);
}

TEST(MountainTops, OnNoBodyHaveNoVisibility) {
  const MemoryDem local(kThree.heights(), {Crs::local(), 0, 0, 30, -30});
  EXPECT_EQ(attribute(tops_of(local)[0], "visibility"), AttributeValue{});
  EXPECT_NE(attribute(tops_of(kThree)[0], "visibility"), AttributeValue{});
}

constexpr Meters kEarth{6371000}, kRange{10000};

double number(int low, int high) {
  return 0.1 * *rc::gen::inRange(10 * low, 10 * high);
}

RC_GTEST_PROP(Visibility, NeverFallsWithProminenceIsolationOrTheBodysRadius, ()) {
  const Meters prominence{number(1, 5000)}, isolation{number(1, 500000)}, radius{number(1000000, 7000000)};
  const double fraction = expected_visibility(prominence, isolation, radius, kRange);
  const double more = 1 + number(0, 3);
  RC_ASSERT(fraction >= 0);
  RC_ASSERT(fraction <= 1);
  RC_ASSERT(expected_visibility(more * prominence, isolation, radius, kRange) >= fraction);
  RC_ASSERT(expected_visibility(prominence, more * isolation, radius, kRange) >= fraction);
  RC_ASSERT(expected_visibility(prominence, isolation, more * radius, kRange) >= fraction);
}

TEST(Visibility, IsTheAverageOfItsModelOverTheDisc) {
  const double prominence = 300, isolation = 4000;
  const double free_length = std::sqrt(kSightLength * std::sqrt(prominence * isolation));
  double sum = 0;
  const int rings = 200000;
  for (int i = 0; i < rings; ++i) {
    const double r = kRange.value * (i + 0.5) / rings;
    if (r * r < 2 * kEarth.value * prominence)
      sum += std::exp(-r / free_length) * 2 * r / kRange.value / rings;
  }
  EXPECT_NEAR(expected_visibility({prominence}, {isolation}, kEarth, kRange), sum, 1e-6);
}

TEST(Visibility, TheCurveOfASmallBodyHidesALowHill) {
  const double on_earth = expected_visibility({1}, {1e5}, kEarth, kRange);
  const double on_phobos = expected_visibility({1}, {1e5}, {11000}, kRange);
  EXPECT_LT(on_phobos, on_earth / 50);
  EXPECT_GT(on_phobos, 0);
}

TEST(Visibility, TheHighestSummitHasNoLimitOfIsolation) {
  EXPECT_EQ(expected_visibility({500}, {std::numeric_limits<double>::infinity()}, kEarth, kRange),
            expected_visibility({500}, kRange, kEarth, kRange));
}

TEST(Visibility, NothingIsSeenOfWhatDoesNotStandOut) {
  EXPECT_EQ(expected_visibility({0}, {1000}, kEarth, kRange), 0);
  EXPECT_EQ(expected_visibility({100}, {0}, kEarth, kRange), 0);
  EXPECT_EQ(expected_visibility({std::nan("")}, {1000}, kEarth, kRange), 0);
}

}  // namespace
}  // namespace waymark::test
