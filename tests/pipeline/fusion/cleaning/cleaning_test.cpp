// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/fusion/association/merging.hpp"
#include "pipeline/fusion/cleaning/rejections.hpp"
#include "pipeline/fusion/valuation/landmark_valuation.hpp"
#include "tests/pipeline/fusion/own_types.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

Observation rock(double x, double y, double radius, double height = 0, std::string source = "a") {
  Observation o;
  o.type = kTypes.id("rock");
  o.source = std::move(source);
  o.position.xyz << x, y, 0;
  o.covariance = Eigen::Matrix3d::Identity() * 0.01;
  o.features = {{radius, 0.0001, 1}, {}};
  if (height > 0) o.features[1] = {height, 0.0001, 1};
  return o;
}
Observation crater(double x, double y, double radius, double depth, std::string source = "a") {
  Observation o = rock(x, y, radius, 0, std::move(source));
  o.type = kTypes.id("crater");
  o.features = {
      {radius, 0.0001, 1}, {depth, 0.0001, 1}, {2 * radius, 0.0001, 1}, {2 * radius, 0.0001, 1}, {}};
  return o;
}

TEST(RejectImplausible, NamesTheReason) {
  std::vector<Observation> all{rock(0, 0, 0.5, 0.4), rock(0, 0, 0.5, 9),     rock(0, 0, 500),
                               crater(0, 0, 10, 2),  crater(0, 0, 10, -0.5), crater(0, 0, 10, 0.05)};
  reject_implausible(all, kTypes);
  const std::vector<std::string> reasons{"", "too tall",       "implausible radius",
                                         "", "negative depth", "too shallow"};
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].rejected, reasons[i]) << i;
}

TEST(RejectImplausible, DoubtIsInFavour) {
  std::vector<Observation> all{crater(0, 0, 10, -0.5)};
  all[0].features[1].variance = 1;
  reject_implausible(all, kTypes);
  EXPECT_EQ(all[0].rejected, "");
}

TEST(RejectRimShadows, OnlyWideShadowsOnTheRimTowardsTheSun) {
  // A crater of radius 10 about the origin, sun in the east.
  std::vector<Observation> all{
      crater(0, 0, 10, 2),   // 0
      rock(9, 0, 3),         // 1: on the sunward rim
      rock(-9, 0, 3),        // 2: on the other rim, whose inner side is lit
      rock(2, 0, 3),         // 3: on the floor
      rock(20, 0, 3),        // 4: outside
      rock(9, 0, 0.3),       // 5: a small rock on the rim
      rock(9, 0, 3, 0, "b")  // 6: another image with the sun in the west
  };
  const std::map<std::string, Sun> suns{{"a", {Degrees{90}, Degrees{30}}},
                                        {"b", {Degrees{270}, Degrees{30}}}};
  const auto craters = all;
  reject_rim_shadows(all, craters, kTypes, suns, Crs::local());
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(all[i].rejected, i == 1 ? "shadow of a crater's rim" : "") << i;
}

TEST(RejectTerrainShadows, BehindACliff) {
  Grid<float> heights(101, 101, 0);
  for (std::int64_t r = 0; r < 101; ++r)
    for (std::int64_t c = 60; c < 101; ++c) heights(c, r) = 20;  // high ground from x = 10 on
  const Terrain terrain(std::move(heights), -50, 50, 1, 1);
  ImageView image;
  image.name = "a";
  image.sun = Sun{Degrees{90}, Degrees{30}};  // shadow of the cliff: 35 m
  std::vector<Observation> all{rock(0, 0, 0.5, 0.4), rock(-40, 0, 0.5, 0.4)};
  reject_terrain_shadows(all, kTypes, image, terrain, 1);
  EXPECT_EQ(all[0].rejected, "in the terrain's shadow");
  EXPECT_EQ(all[1].rejected, "");
}

// The scarp is as large as the supposed rock, so a ray that starts beyond the rock misses it.
TEST(RejectTerrainShadows, OfReliefAsLargeAsTheRock) {
  Grid<float> heights(101, 101, 0);
  for (std::int64_t r = 40; r < 61; ++r)
    for (std::int64_t c = 52; c < 62; ++c) heights(c, r) = 3;
  const Terrain terrain(std::move(heights), -50, 50, 1, 1);
  ImageView image;
  image.name = "a";
  image.sun = Sun{Degrees{90}, Degrees{30}};
  std::vector<Observation> all{rock(2, 0, 3, 3), rock(-40, 0, 3, 3)};
  reject_terrain_shadows(all, kTypes, image, terrain, 1);
  EXPECT_EQ(all[0].rejected, "dark by the terrain's relief");
  EXPECT_EQ(all[1].rejected, "");
}

TEST(MergeObservations, MergesByEquationThree) {
  std::vector<Observation> all{rock(0, 0, 1.0, 0, "a"), rock(0.05, 0, 1.2, 0, "b")};
  all[0].confidence = 0.9, all[1].confidence = 0.3;
  const auto merged = merge_observations(all, kTypes, Crs::local());
  ASSERT_EQ(merged.landmarks.size(), 1u);
  const Landmark& l = merged.landmarks[0];
  EXPECT_NEAR(l.features[0].value, (0.9 * 1.0 + 0.3 * 1.2) / 1.2, 1e-12);
  EXPECT_EQ(l.features[0].observations, 2);
  EXPECT_FALSE(l.features[1].known());
  EXPECT_NEAR(l.position.xyz.x(), 0.025, 1e-3);  // the smaller one has a slightly larger weight
  EXPECT_EQ(merged.evidence[0].landmark_uid, l.uid);
  EXPECT_EQ(merged.evidence[1].landmark_uid, l.uid);
}

TEST(MergeObservations, TwinsInOneImageAreToldAsSuch) {
  std::vector<Observation> all{rock(0, 0, 1.0), rock(0.1, 0, 1.1), rock(5, 0, 1)};
  all[0].confidence = 0.6;
  const auto merged = merge_observations(all, kTypes, Crs::local());
  EXPECT_EQ(merged.landmarks.size(), 2u);
  int twins = 0;
  for (const Observation& o : merged.evidence) twins += o.rejected == "seen twice in one image";
  EXPECT_EQ(twins, 1);
}

TEST(MergeObservations, HeightsMayBeUnknown) {
  std::vector<Observation> all{rock(0, 0, 1.0, 0, "a"), rock(0.05, 0, 1.2, 0, "b")};
  for (Observation& o : all) o.covariance(2, 2) = std::nan("");
  const auto merged = merge_observations(all, kTypes, Crs::local());
  ASSERT_EQ(merged.landmarks.size(), 1u);
  EXPECT_TRUE(std::isnan(merged.landmarks[0].covariance(2, 2)));
  EXPECT_GT(merged.landmarks[0].covariance(0, 0), 0);
}

TEST(MergeObservations, RejectedPassThrough) {
  std::vector<Observation> all{rock(0, 0, 1)};
  all[0].rejected = "too tall";
  const auto merged = merge_observations(all, kTypes, Crs::local());
  EXPECT_TRUE(merged.landmarks.empty());
  EXPECT_EQ(merged.evidence.at(0).rejected, "too tall");
}

ImageView map_image(std::string name, double gsd, double x0 = -50, double y0 = 50, double side = 100) {
  ImageView image;
  image.name = std::move(name);
  image.columns = image.rows = static_cast<std::int64_t>(side / gsd);
  image.ortho = OrthoGrid{x0 + gsd / 2, y0 - gsd / 2, gsd, -gsd};
  image.footprint = {{{x0, y0}, {x0 + side, y0}, {x0 + side, y0 - side}, {x0, y0 - side}, {x0, y0}}};
  image.area = side * side, image.gsd = gsd;
  return image;
}

struct Valued {
  Landmark sound, paper;
};
Valued value(const std::vector<Observation>& seen, const std::vector<ImageView>& images) {
  auto merged = merge_observations(seen, kTypes, Crs::local());
  Valued valued{merged.landmarks.at(0), merged.landmarks.at(0)};
  value_landmarks({&valued.sound, 1}, merged.evidence, images, nullptr, kTypes, 1);
  value_landmarks({&valued.paper, 1}, merged.evidence, images, nullptr, kTypes, 1,
                  {.cover = CoverRule::paper, .spread = SpreadRule::paper});
  return valued;
}

TEST(ValueLandmarks, CountsByEquationsFourAndFive) {
  const std::vector<ImageView> images{map_image("coarse", 1), map_image("middle", 0.5, -30, 30, 60),
                                      map_image("fine", 0.1, -10, 10, 20),
                                      map_image("away", 0.1, 20, 40, 20)};
  // Detected in the medium image: the coarse one need not show it, the fine one should.
  const auto one = value({rock(0, 0, 1, 0, "middle")}, images);
  EXPECT_EQ(one.sound.quality.seen, 1);
  EXPECT_EQ(one.sound.quality.visible, 2);
  EXPECT_EQ(one.paper.quality.visible, 2);
  EXPECT_FALSE(one.sound.quality.feature_confidences[0]);    // one observation has no spread
  EXPECT_EQ(one.paper.quality.feature_confidences[0], 1.0);  // the paper's formula says certain
  const auto all = value({rock(0, 0, 1, 0, "coarse"), rock(0.1, 0, 1.1, 0, "fine")}, images);
  EXPECT_EQ(all.sound.quality.seen, 2);
  EXPECT_EQ(all.sound.quality.visible, 3);
  EXPECT_TRUE(all.sound.quality.feature_confidences[0]);
  EXPECT_GT(all.sound.confidence, one.sound.confidence - 1e-9);
}

TEST(ValueLandmarks, OutlinesThatReachBeyondTheImageDoNotCount) {
  const std::vector<ImageView> images{map_image("whole", 0.5), map_image("part", 0.5, -100, 50, 101)};
  const auto valued = value({rock(0, 0, 4, 0, "whole")}, images);
  EXPECT_EQ(valued.sound.quality.visible, 1);
  EXPECT_EQ(valued.paper.quality.visible, 1 + 0);  // area(part) > area(whole)
}

TEST(ValueLandmarks, SourceWithoutImageIsASurvey) {
  const auto valued = value({crater(0, 0, 10, 2, "dem.tif")}, {});
  EXPECT_EQ(valued.sound.quality.seen, 1);
  EXPECT_EQ(valued.sound.quality.visible, 1);
}

TEST(Existence, FurtherImagesHelpAndMissesHurt) {
  const double one[] = {0.8}, two[] = {0.8, 0.8}, doubt[] = {0.8, 0.5};
  EXPECT_NEAR(existence_probability(one, 0), 0.8, 1e-12);
  EXPECT_GT(existence_probability(two, 0), 0.8);
  EXPECT_NEAR(existence_probability(doubt, 0), 0.8, 1e-12);
  EXPECT_LT(existence_probability(one, 1), 0.8);
  EXPECT_EQ(existence_probability({}, 0), 0);
}

const ExistenceRules& rules(std::string_view type) {
  return kTypes[kTypes.id(type)].existence;
}

TEST(Existence, RocksAreDoubtedMoreThanCraters) {
  const double one[] = {0.9};
  EXPECT_NEAR(existence_probability(one, 0, rules("rock")), 9 / (9 + std::exp(1.5)), 1e-12);
  EXPECT_NEAR(existence_probability(one, 0, rules("crater")), 0.9, 1e-12);
  EXPECT_NEAR(existence_probability(one, 0, rules("mountain_top")), 0.9, 1e-12);
}

// Further images of a crater add little evidence, and a missed detection counts little against it.
TEST(Existence, CratersAreSeenThroughTheSameDemInEveryImage) {
  const double three[] = {0.9, 0.8, 0.5};
  const double logit = std::log(9) + 0.1 * std::log(4) - 2 * 0.1;
  EXPECT_NEAR(existence_probability(three, 2, rules("crater")), 1 / (1 + std::exp(-logit)), 1e-12);
}

TEST(RemoveImprobable, KeepsTheEvidenceAndSaysWhy) {
  std::vector<Landmark> all(4);
  for (std::size_t i = 0; i < 4; ++i)
    all[i].type = kTypes.id("rock"), all[i].uid = std::string(1, char('a' + i));
  all[0].confidence = 0.49, all[1].confidence = 0.5, all[2].confidence = 0.1, all[3].confidence = 0.49;
  all[2].type = kTypes.id("mountain_top");
  all[3].type = kTypes.id("crater");
  std::vector<Observation> seen{rock(0, 0, 1), rock(1, 0, 1), rock(2, 0, 1), rock(3, 0, 1)};
  seen[0].landmark_uid = "a", seen[1].landmark_uid = "b", seen[2].landmark_uid = "c";
  seen[3].rejected = "too tall";
  EXPECT_EQ(remove_improbable(all, seen, kTypes), 2);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].uid, "b");
  EXPECT_EQ(all[1].uid, "c");
  EXPECT_EQ(seen[0].rejected, "landmark improbable");
  EXPECT_EQ(seen[0].landmark_uid, "");
  EXPECT_EQ(seen[1].rejected, "");
  EXPECT_EQ(seen[1].landmark_uid, "b");
  EXPECT_EQ(seen[3].rejected, "too tall");
}

}  // namespace
}  // namespace waymark::test
