// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/place_on_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.hpp"
#include "tests/pipeline/reconstruction/made_pictures.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
namespace {

using pipeline::LevelImage;

LevelImage made_map(const MadeGround& ground, std::int64_t cells = 240, double cell = 4) {
  LevelImage out{.grid = {.west = 5000, .north = 9000, .cell = cell, .columns = cells, .rows = cells}};
  out.brightness = Grid<float>(cells, cells);
  for (std::int64_t r = 0; r < cells; ++r)
    for (std::int64_t c = 0; c < cells; ++c)
      out.brightness(c, r) =
          static_cast<float>(ground.brightness(out.grid.x(double(c)), out.grid.y(double(r))));
  return out;
}

// What the images of a part of the ground show, in units and axes of their own.
LevelImage made_mosaic(const MadeGround& ground, const Similarity& map_from_mosaic, double gain = 1,
                       double noise = 0) {
  constexpr std::int64_t kCells = 160;
  LevelImage out{
      .grid = {.west = -500, .north = 500, .cell = 1000.0 / kCells, .columns = kCells, .rows = kCells}};
  out.brightness = Grid<float>(kCells, kCells);
  Random random(5);
  for (std::int64_t r = 0; r < kCells; ++r)
    for (std::int64_t c = 0; c < kCells; ++c) {
      const Eigen::Vector3d at =
          map_from_mosaic * Eigen::Vector3d(out.grid.x(double(c)), out.grid.y(double(r)), 0);
      const double haze = 20 * std::sin(double(c) / 40);
      out.brightness(c, r) =
          static_cast<float>(30 + haze + gain * ground.brightness(at.x(), at.y()) + random.normal(0, noise));
      if (std::hypot(double(c) - 80, double(r) - 80) > 78)
        out.brightness(c, r) = std::nanf("");  // not covered
    }
  return out;
}

Similarity placement(double scale, double yaw, double x, double y) {
  return {.scale = scale,
          .rotation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
          .shift = {x, y, 0}};
}

// Fewer scales than by default, for time. Small mosaics take most of it.
constexpr pipeline::ImagePlacementRules kRules{.largest = 0.8, .smallest = 0.25},
    kWithSmallMosaics{.largest = 0.8, .smallest = 0.15};

constexpr MadeGround kMapGround{.longest = 200, .shortest = 8, .seed = 3};

TEST(PlaceOnImage, FindsShiftYawAndScale) {
  const LevelImage map = made_map(kMapGround);
  for (const Similarity& truth :
       {placement(0.4, 130 * kDegree, 5520, 8480), placement(0.17, -75 * kDegree, 5300, 8300)}) {
    const auto placed =
        pipeline::place_on_image(made_mosaic(kMapGround, truth, 0.4, 4), map, kWithSmallMosaics);
    ASSERT_TRUE(placed.found) << placed.message;
    const Similarity& found = placed.found->map_from_mosaic;
    EXPECT_NEAR(found.scale / truth.scale, 1, 0.01);
    EXPECT_NEAR(Eigen::AngleAxisd(found.rotation.transpose() * truth.rotation).angle(), 0, 0.01);
    EXPECT_LT((found.shift - truth.shift).norm(), 6);  // 1.5 cells of the map
    EXPECT_GT(placed.found->score, 2 * placed.found->next_best_score);
  }
}

TEST(PlaceOnImage, AMosaicMayReachBeyondTheMap) {
  const Similarity truth = placement(0.35, 0.3, 5120, 8700);  // of 350 m: 55 m are beyond the western border
  const auto placed = pipeline::place_on_image(made_mosaic(kMapGround, truth), made_map(kMapGround), kRules);
  ASSERT_TRUE(placed.found) << placed.message;
  EXPECT_LT((placed.found->map_from_mosaic.shift - truth.shift).norm(), 6);
}

TEST(PlaceOnImage, OtherGroundIsRefused) {
  for (std::uint32_t seed = 10; seed < 13; ++seed) {
    const MadeGround other{.longest = 200, .shortest = 8, .seed = seed};
    const auto placed =
        pipeline::place_on_image(made_mosaic(other, placement(0.4, 1, 5500, 8500)), made_map(kMapGround),
                                 seed == 10 ? kWithSmallMosaics : kRules);
    EXPECT_FALSE(placed.found) << seed << ": " << placed.found->score << ", next "
                               << placed.found->next_best_score;
    EXPECT_NE(placed.message, "");
  }
}

TEST(PlaceOnImage, GroundThatRepeatsItselfIsAmbiguous) {
  LevelImage map = made_map(kMapGround);
  for (std::int64_t r = 0; r < map.grid.rows; ++r)
    for (std::int64_t c = map.grid.columns / 2; c < map.grid.columns; ++c)
      map.brightness(c, r) = map.brightness(c - map.grid.columns / 2, r);
  const auto placed =
      pipeline::place_on_image(made_mosaic(kMapGround, placement(0.3, 0, 5240, 8500)), map, kRules);
  EXPECT_FALSE(placed.found);
  EXPECT_NE(placed.message.find("ambiguous"), std::string::npos) << placed.message;
}

TEST(PlaceOnImage, ImagesWithoutPatternAreRefused) {
  LevelImage grey = made_map(kMapGround), empty = grey;
  for (float& v : grey.brightness.cells()) v = 100;
  for (float& v : empty.brightness.cells()) v = std::numeric_limits<float>::quiet_NaN();
  const LevelImage mosaic = made_mosaic(kMapGround, placement(0.4, 0, 5500, 8500));
  for (const LevelImage& map : {grey, empty}) {
    EXPECT_FALSE(pipeline::place_on_image(mosaic, map, kRules).found);
    LevelImage flat = mosaic;
    flat.brightness = Grid<float>(160, 160, map.brightness(0, 0));
    EXPECT_FALSE(pipeline::place_on_image(flat, made_map(kMapGround), kRules).found);
  }
}

// The slow twin: the correlation by its definition, at the place that was found.
TEST(PlaceOnImage, TheScoreIsTheCorrelationOfBrightness) {
  const Similarity truth = placement(0.4, 0.8, 5500, 8500);
  const LevelImage mosaic = made_mosaic(kMapGround, truth);
  const auto placed = pipeline::place_on_image(mosaic, made_map(kMapGround), kRules);
  ASSERT_TRUE(placed.found) << placed.message;
  const auto correlation = [&](const Similarity& to) {
    double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (std::int64_t r = 0; r < mosaic.grid.rows; ++r)
      for (std::int64_t c = 0; c < mosaic.grid.columns; ++c) {
        const double here = mosaic.brightness(c, r);
        if (std::isnan(here)) continue;
        const Eigen::Vector3d at =
            to * Eigen::Vector3d(mosaic.grid.x(double(c)), mosaic.grid.y(double(r)), 0);
        const double there = kMapGround.brightness(at.x(), at.y());
        n += 1, a += here, b += there, aa += here * here, bb += there * there, ab += here * there;
      }
    return (ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n));
  };
  EXPECT_GT(correlation(placed.found->map_from_mosaic), 0.9);
  Similarity turned = placed.found->map_from_mosaic;
  for (int i = 1; i < 12; ++i) {
    turned.rotation =
        Eigen::AngleAxisd(i * 0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix() * truth.rotation;
    EXPECT_LT(correlation(turned), 0.5 * placed.found->score) << i;
  }
}

}  // namespace
}  // namespace waymark::test
