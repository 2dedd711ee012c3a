// SPDX-License-Identifier: Apache-2.0
#include "planning/hazard_map.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "tests/support/dem_art.hpp"

namespace waymark::test {
namespace {

using namespace planning;

Vehicle cart() {
  Vehicle vehicle{.name = "cart", .summary = {}, .supports = {}};
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.4, 0.4}) vehicle.supports.push_back({{x}, {y}, {0.4}, {0.2}});
  return vehicle;
}

MemoryDem level(std::int64_t size, double cell, double height = 0) {
  return {Grid<double>(size, size, height), {.dx = cell, .dy = -cell}, NodataPolicy::unknown};
}

float value(const HazardTile& tile, HazardBand band, std::int64_t c, std::int64_t r) {
  return tile[static_cast<std::size_t>(band)](c, r);
}

TEST(HazardMap, LevelTerrainIsSafeAndItsRimUnknown) {
  const MemoryDem dem = level(20, 0.25);
  const HazardMap map(dem, {.vehicle = cart()}, {});
  const HazardTile tile = map.compute({0, 0, 20, 20});
  const std::int64_t rim = map.footprint().half_columns;
  for (std::int64_t r = 0; r < 20; ++r)
    for (std::int64_t c = 0; c < 20; ++c) {
      const bool inside = std::min({c, r, 19 - c, 19 - r}) >= rim;
      EXPECT_EQ(value(tile, HazardBand::hazard_class, c, r), inside ? 0 : 3);
      EXPECT_EQ(std::isnan(value(tile, HazardBand::probability, c, r)), !inside);
    }
}

TEST(HazardMap, SlopeAtTheLimitIsAnEvenChance) {
  Vehicle vehicle = cart();
  vehicle.max_slope = Degrees{std::atan(0.25) * 180 / std::numbers::pi};
  vehicle.max_step = vehicle.max_roughness = Meters{10};
  MemoryDem dem(dem_art("0 1 2 3 4 5 6 / 0 1 2 3 4 5 6 / 0 1 2 3 4 5 6 / 0 1 2 3 4 5 6 / 0 1 2 3 4 5 6"),
                {.dx = 4, .dy = -4}, NodataPolicy::unknown);
  const HazardMap map(dem, {.vehicle = vehicle, .errors = {.sd = 0.05}}, {});
  EXPECT_NEAR(value(map.compute({0, 0, 7, 5}), HazardBand::probability, 3, 2), 0.5, 1e-4);
}

TEST(HazardMap, RockHasItsRadiusAndThatOfTheBase) {
  const MemoryDem dem = level(81, 0.25);
  const double base = cart().base_radius();
  const HazardObject rock{.position = {10, -10}, .radius = 0.5, .probability = 0.8};
  const HazardMap map(dem, {.vehicle = cart()}, {rock});
  const HazardTile tile = map.compute({0, 0, 81, 81});
  for (std::int64_t r = 0; r < 81; ++r)
    for (std::int64_t c = 0; c < 81; ++c) {
      const double distance = std::hypot(double(c) * 0.25 - 10, 10 - double(r) * 0.25);
      EXPECT_FLOAT_EQ(value(tile, HazardBand::object, c, r), distance < base + 0.5 ? 0.8F : 0.F);
    }
}

TEST(HazardMap, TilesDoNotChangeTheBytes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  Grid<double> heights = random_terrain(6, 90, 75);
  for (double& h : heights.cells())
    if (h > kNoHeight) h *= 0.02;
  const MemoryDem dem(heights, {.x0 = 100, .y0 = 50, .dx = 0.3, .dy = -0.3}, NodataPolicy::unknown);
  std::vector<HazardObject> objects;
  for (int i = 0; i < 60; ++i)
    objects.push_back({.position = {100 + 27 * uniform(random), 50 - 22 * uniform(random)},
                       .covariance = Eigen::Matrix2d::Identity() * 0.1 * uniform(random),
                       .radius = uniform(random),
                       .radius_sd = 0.1,
                       .probability = uniform(random)});
  UndetectedRocks undetected{.known = true,
                             .cover = {0.1, 0.02},
                             .min_height = 0.15,
                             .detected_diameter = 0.8,
                             .surveyed = {{{103, 30}, {120, 33}, {115, 48}}}};
  const HazardMap map(dem, {.vehicle = cart(), .errors = {0.02, 0.5}, .undetected = undetected}, objects);
  const HazardTile whole = map.compute({0, 0, 90, 75});
  for (const std::int64_t size : {7, 16, 64})
    for (std::int64_t row = 0; row < 75; row += size)
      for (std::int64_t column = 0; column < 90; column += size) {
        const Window window{column, row, std::min(size, 90 - column), std::min(size, 75 - row)};
        const HazardTile tile = map.compute(window);
        for (std::size_t b = 0; b < kHazardBands; ++b)
          for (std::int64_t r = 0; r < window.rows; ++r)
            ASSERT_EQ(std::memcmp(tile[b].row(r).data(), whole[b].row(row + r).data() + column,
                                  tile[b].row(r).size_bytes()),
                      0)
                << "band " << b << ", tile of " << size << " at " << column << " " << row;
      }
}

TEST(HazardMap, ErrorsOfThePlaneAreThoseOfRandomHeights) {
  // 4000 bases of white errors: the spread of their gradients and residuals is the one propagated.
  const HeightErrors errors{.sd = 0.1};
  const BaseFootprint base = make_base_footprint(0.5, 0.5, 2, 0.5);
  const FitErrors fit = propagate_errors(base, errors);
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, errors.sd);
  double gradient = 0, squares = 0, squares_of_squares = 0;
  const int count = 4000;
  for (int i = 0; i < count; ++i) {
    HeightWindow heights(2 * base.half_columns + 1, 2 * base.half_rows + 1);
    for (double& h : heights.cells()) h = normal(random);
    const BaseRelief relief = fit_base_directly(heights, base.half_columns, base.half_rows, base);
    gradient += std::pow(relief.gradient_x, 2) / count;
    const double ms = std::pow(relief.roughness, 2);
    squares += ms / count, squares_of_squares += ms * ms / count;
  }
  EXPECT_NEAR(gradient / fit.variance_x, 1, 0.08);  // 3.6 sd of a variance from 4000 values
  EXPECT_NEAR(squares / fit.mean_square, 1, 0.02);
  EXPECT_NEAR(std::sqrt(squares_of_squares - squares * squares) / fit.mean_square_sd, 1, 0.1);
}

TEST(ContactProbability, IsThatOfDrawnPositions) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const double sd : {0.1, 0.6, 2.0})
    for (const double distance : {0.0, 1.0, 2.5}) {
      const HazardObject object{.covariance = Eigen::Matrix2d::Identity() * sd * sd, .radius = 0.5};
      int hits = 0;
      for (int i = 0; i < 20000; ++i)
        hits += std::hypot(distance - sd * normal(random), sd * normal(random)) < 1.5;
      const double estimate = contact_probability(object, {distance, 0}, 1);
      EXPECT_GE(estimate, hits / 20000.0 - 0.015) << sd << " " << distance;
      EXPECT_LE(estimate, hits / 20000.0 * 1.35 + 0.015) << sd << " " << distance;  // square for a disc
    }
}

TEST(HazardObject, TypesSayWhatTheyAre) {
  const Vehicle vehicle = cart();  // stops at rocks of 0.3 m, slopes of 20 degrees: 0.364
  TypeRegistry types;
  register_landmark_types(types);
  const auto object = [&](const char* type, std::vector<double> values) {
    Landmark landmark;
    landmark.type = types.id(type);
    landmark.confidence = 0.9;
    for (const double v : values) landmark.features.push_back({v, 1e-8, 2});
    return hazard_object(landmark, types[landmark.type], vehicle);
  };
  EXPECT_NEAR(object("rock", {0.4, 0.9}).probability, 0.9, 1e-5);  // 0.6 m are 4.8 sd of 14 %
  EXPECT_DOUBLE_EQ(object("rock", {0.4, 0.9}).radius, 0.4);
  EXPECT_NEAR(object("rock", {0.4, 0.1}).probability, 0, 1e-5);
  EXPECT_NEAR(object("crater", {10, 8}).probability, 0.9, 1e-4);  // 2 * 8 / 10
  EXPECT_NEAR(object("crater", {10, 0.5}).probability, 0, 1e-5);
  EXPECT_DOUBLE_EQ(object("tree", {20, 0.3, 5}).radius, 0.15);  // the stem, not the crown
  EXPECT_EQ(object("mountain_top", {1000, 30, 500}).probability, 0);
}

}  // namespace
}  // namespace waymark::test
