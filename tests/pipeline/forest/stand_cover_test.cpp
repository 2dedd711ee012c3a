// SPDX-License-Identifier: Apache-2.0
// Cover and tables of stands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "pipeline/forest/stand_cover.hpp"
#include "tests/pipeline/forest/square_stand.hpp"
#include "tests/support/message_of.hpp"
#include "workflows/forest/stand_figures.hpp"

namespace waymark::test {
namespace {

using ::testing::HasSubstr;
TEST(StandCover, CirclesAndOutlinesShadeTheGround) {
  const pipeline::StandPolygon stand = square_stand(0, 0, 100);
  const pipeline::StandCrown circle{.position = {50, 50}, .diameter = 20};
  EXPECT_NEAR(pipeline::canopy_cover(std::span(&circle, 1), stand).value, std::numbers::pi * 100 / 1e4, 2e-4);
  EXPECT_EQ(pipeline::canopy_cover({}, stand).value, 0);
  const pipeline::StandCrown halves[] = {{.position = {0, 50}, .diameter = 20},
                                         {.position = {0, 50}, .diameter = 20}};
  EXPECT_NEAR(pipeline::canopy_cover(halves, stand).value, std::numbers::pi * 50 / 1e4, 5e-4)
      << "half outside; twice is once";
  const pipeline::StandCrown outline{
      .position = {50, 50}, .diameter = 5, .ring = {{40, 40}, {60, 40}, {60, 60}, {40, 60}}};
  EXPECT_NEAR(pipeline::canopy_cover(std::span(&outline, 1), stand).value, 0.04, 1e-9);
  pipeline::StandCrown doubtful = outline;
  doubtful.confidence = 0.5;
  EXPECT_NEAR(pipeline::canopy_cover(std::span(&doubtful, 1), stand).se, 0.02, 1e-9);
  EXPECT_TRUE(std::isnan(pipeline::canopy_cover({}, {}).value));
}

TEST(StandCover, ALongNarrowStandTakesNoMoreMemory) {
  const pipeline::StandPolygon strip{
      {{{0, 0}, {4e12, 0}, {4e12, 0.5}, {0, 0.5}}}};  // 8e9 places by area alone: 32 GB
  EXPECT_NO_THROW(pipeline::canopy_cover({}, strip));
}

TEST(StandCover, MatchesCountingPlaces) {
  Random random(5);
  for (int round = 0; round < 20; ++round) {
    pipeline::StandPolygon stand{{{}}};
    for (int i = 0; i < 9; ++i) {
      const double r = random.uniform(10, 30), a = 2 * std::numbers::pi * i / 9;
      stand.rings[0].emplace_back(r * std::cos(a), r * std::sin(a));
    }
    std::vector<pipeline::StandCrown> crowns;
    for (int i = 0; i < 15; ++i)
      crowns.push_back({.position = {random.uniform(-35, 35), random.uniform(-35, 35)},
                        .diameter = random.uniform(1, 15)});
    int all = 0, covered = 0;
    for (int i = -70; i < 70; ++i)
      for (int j = -70; j < 70; ++j) {
        const Eigen::Vector2d at(0.5 * i, 0.5 * j);
        if (!pipeline::inside(stand, at)) continue;
        ++all;
        covered += std::ranges::any_of(
            crowns, [&](const auto& c) { return (c.position - at).norm() < c.diameter / 2; });
      }
    EXPECT_NEAR(pipeline::canopy_cover(crowns, stand).value, static_cast<double>(covered) / all, 1e-12);
  }
}

TEST(StandTables, SayWhatIsWrong) {
  const auto refused = [](const char* csv) -> std::string {
    return message_of([&] { pipeline::parse_volume(csv, "v.csv"); });
  };
  const auto rows = pipeline::parse_volume(
      "species,form_factor,form_factor_sd,mass_per_volume\nSpruce,0.45,0.03,600\nall,0.5,,\n", "v");
  EXPECT_EQ(pipeline::volume_of(rows, "spruce")->form_factor, 0.45);
  EXPECT_EQ(pipeline::volume_of(rows, "oak")->form_factor, 0.5);
  EXPECT_TRUE(std::isnan(rows[1].mass_per_volume));
  EXPECT_EQ(pipeline::volume_of(std::span(rows).first(1), "oak"), nullptr);
  EXPECT_THAT(refused("species,form_factr\nall,0.5\n"), HasSubstr("did you mean 'form_factor'?"));
  EXPECT_THAT(refused("species,form_factor\nall,5\n"), HasSubstr("form_factor = 5 is outside [0.05, 1]"));
  EXPECT_THAT(refused("species,form_factor\nall,x\n"), HasSubstr("v.csv, line 2"));
  EXPECT_THAT(refused("species,form_factor\n"), HasSubstr("no rows"));
  EXPECT_EQ(pipeline::parse_recall("height_from,recall\n0,0.5\n10,0.9\n", "r").size(), 2u);
  EXPECT_THROW(pipeline::parse_recall("height_from,recall\n10,0.5\n0,0.9\n", "r"), Error);
  EXPECT_THROW(pipeline::parse_recall("height_from,recall\n0,1.5\n", "r"), Error);
}

TEST(AirRecall, RisesWithTheHeightOfATree) {
  for (const double crowns : {0.1, 0.194, 0.22, 0.246, 0.27, 0.295, 0.5}) {
    EXPECT_TRUE(workflows::airborne_recall(std::nan(""), crowns).empty());
    const std::vector<pipeline::RecallRow> rows = workflows::airborne_recall(30, crowns);
    ASSERT_GT(rows.size(), 3u);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_GT(rows[i].recall, 0);
      EXPECT_LE(rows[i].recall, 1);
      EXPECT_GT(rows[i].sd, 0) << "what other forests have is not known for sure";
      if (i > 0) {
        EXPECT_GT(rows[i].height_from, rows[i - 1].height_from);
        EXPECT_GE(rows[i].recall, rows[i - 1].recall);
      }
    }
    EXPECT_NEAR(workflows::airborne_recall(15, crowns)[2].height_from, rows[2].height_from / 2, 1e-9);
  }
}

}  // namespace
}  // namespace waymark::test
