// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/find_buildings.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <tuple>

#include "importers/points/canopy.hpp"
#include "pipeline/buildings/find_poles.hpp"
#include "tests/pipeline/buildings/town_score.hpp"
#include "tests/pipeline/forest/synthetic_canopy.hpp"

namespace waymark::test {
namespace {

using ::testing::UnorderedElementsAreArray;

/// Everything of a building that a map shows.
using Shown = std::tuple<std::vector<double>, double, double, double, std::string>;
std::vector<Shown> shown(const std::vector<DetectedBuilding>& buildings) {
  std::vector<Shown> all;
  for (const DetectedBuilding& b : buildings) {
    std::vector<double> numbers;
    for (const Eigen::Vector2d& v : b.outline.outer.vertices)
      numbers.push_back(v.x()), numbers.push_back(v.y());
    numbers.insert(numbers.end(), b.outline.outer.sd.begin(), b.outline.outer.sd.end());
    all.emplace_back(numbers, b.height, b.area, b.confidence, to_string(b.roof));
  }
  return all;
}

FoundBuildings find_in(const MadeTown& town, const ScanRules& scan, std::uint64_t seed,
                       const RoofRules& rules = {}) {
  const TownCanopy canopy(town, scan_town(town, scan, seed), scan.density);
  return find_buildings(canopy, canopy.all(), rules);
}

struct AtDensity {
  double density, recall, precision, iou, corner_rms, height_rms;
};

class FindBuildings : public ::testing::TestWithParam<AtDensity> {};

// The limits are those measured, with a margin of about a third; docs/evaluation has the figures.
TEST_P(FindBuildings, MadeTownsGetTheirHousesBack) {
  const AtDensity& at = GetParam();
  TownScore s;
  for (std::uint64_t seed = 101; seed <= 102; ++seed) {
    const MadeTown town = made_town(seed);
    const TownCanopy canopy(town, scan_town(town, {.density = at.density}, seed), at.density);
    score(town, canopy, find_buildings(canopy, canopy.all(), {}).buildings, s);
  }
  std::printf(
      "density %4.0f: recall %.3f precision %.3f IoU %.3f area %+.3f, corners %d of %d, %d false, rms %.2f "
      "m, "
      "NEES %.2f, height %+.2f m, rms %.2f m;",
      at.density, s.recall(), s.precision(), s.mean_iou(), s.area / s.matched, s.corners_found, s.corners,
      s.false_corners, s.corner_rms(), s.nees / s.corners_found / 2, s.height_bias(), s.height_rms());
  for (const auto& [kind, count] : s.kinds) std::printf(" %d %s", count, kind.c_str());
  std::printf("\n");
  EXPECT_GE(s.recall(), at.recall);
  EXPECT_GE(s.precision(), at.precision);
  EXPECT_GE(s.mean_iou(), at.iou);
  EXPECT_LE(s.corner_rms(), at.corner_rms);
  EXPECT_LE(s.height_rms(), at.height_rms);
}
INSTANTIATE_TEST_SUITE_P(Densities, FindBuildings,
                         ::testing::Values(AtDensity{1, 0.95, 0.95, 0.87, 0.65, 0.15},
                                           AtDensity{2, 0.95, 0.95, 0.9, 0.5, 0.15},
                                           AtDensity{4, 0.95, 0.95, 0.91, 0.5, 0.15},
                                           AtDensity{8, 0.95, 0.95, 0.95, 0.35, 0.1},
                                           AtDensity{30, 0.95, 0.95, 0.96, 0.35, 0.1}));

TEST(FindBuildingsOfPoints, TreesAreNoBuildings) {
  int found = 0;
  for (const double density : {1.0, 2.0, 4.0, 8.0, 30.0})
    for (std::uint64_t seed = 111; seed <= 111; ++seed) {
      const MadeTown forest = made_town(seed, 120, false);
      found += int(find_in(forest, {.density = density}, seed).buildings.size());
      // Without numbers of returns the roughness alone decides.
      found += int(find_in(forest, {.density = density, .returns_known = false}, seed).buildings.size());
    }
  EXPECT_EQ(found, 0);
}

TEST(FindBuildingsOfPoints, ReturnNumbersAndClassesAreNotNeeded) {
  TownScore s;
  const MadeTown town = made_town(121);
  const TownCanopy canopy(town,
                          scan_town(town, {.density = 8, .returns_known = false, .classified = false}, 1), 8);
  score(town, canopy, find_buildings(canopy, canopy.all(), {}).buildings, s);
  EXPECT_GE(s.recall(), 0.9);
  EXPECT_GE(s.precision(), 0.9);
  EXPECT_GE(s.mean_iou(), 0.9);
}

TEST(FindBuildingsOfPoints, TheOrderOfReturnsDoesNotMatter) {
  const MadeTown town = made_town(122, 72);
  auto returns = scan_town(town, {.density = 6}, 1);
  const TownCanopy canopy(town, returns, 6);
  Random random(5, "order");
  for (std::size_t i = returns.size(); i > 1; --i)
    std::swap(returns[i - 1], returns[random.uniform_index(i)]);
  const TownCanopy shuffled(town, returns, 6);
  const auto a = find_buildings(canopy, canopy.all(), {}), b = find_buildings(shuffled, shuffled.all(), {});
  EXPECT_GE(a.buildings.size(), 3U);
  EXPECT_EQ(shown(a.buildings), shown(b.buildings));
  EXPECT_EQ(a.rejected, b.rejected);
}

TEST(FindBuildingsOfPoints, TilesFindWhatTheWholeDoes) {
  const MadeTown town = made_town(123);
  for (const double density : {1.0, 6.0}) {
    const TownCanopy canopy(town, scan_town(town, {.density = density}, 1), density);
    // A small extent keeps the tiles from reading the whole survey.
    const RoofRules rules{.max_extent = 30};
    const auto whole = find_buildings(canopy, canopy.all(), rules);
    std::vector<DetectedBuilding> of_tiles;
    std::map<std::string, std::int64_t> rejected;
    const std::int64_t side = canopy.all().columns / 5 + 1;
    for (std::int64_t r = 0; r < 5; ++r)
      for (std::int64_t c = 0; c < 5; ++c) {
        const Window owned{c * side, r * side, std::min(side, canopy.all().columns - c * side),
                           std::min(side, canopy.all().rows - r * side)};
        const auto part = find_buildings(canopy, owned, rules);
        for (const DetectedBuilding& b : part.buildings)
          if (owned.contains(b.first_column, b.first_row)) of_tiles.push_back(b);
        for (const auto& [reason, count] : part.rejected) rejected[reason] += count;
      }
    EXPECT_GE(whole.buildings.size(), 8U);
    EXPECT_THAT(shown(of_tiles), UnorderedElementsAreArray(shown(whole.buildings)));
    EXPECT_EQ(rejected, whole.rejected);
  }
}

TEST(FindBuildingsOfPoints, ATurnedTownHasTheSameHouses) {
  MadeTown town = made_town(124, 96);
  town.slope_x = town.slope_y = 0;
  const auto returns = scan_town(town, {.density = 8}, 1);
  const double turn = 0.35;
  const Eigen::Rotation2Dd by(turn);
  const Eigen::Vector2d middle(48, 48), shift(70, 70);  // room for the corners
  MadeTown turned = town;
  turned.side = 140;
  std::vector<TownReturn> of_turned = returns;
  for (TownReturn& p : of_turned) {
    const Eigen::Vector2d at = by * (Eigen::Vector2d(p.x, p.y) - middle) + shift;
    // Its height above the ground of the other town is that above its own.
    p.z += turned.ground(at.x(), at.y()) - town.ground(p.x, p.y);
    p.x = at.x(), p.y = at.y();
  }
  for (House& h : turned.houses) h.at = by * (h.at - middle) + shift, h.turn += turn;
  const TownCanopy straight(town, returns, 8), other(turned, of_turned, 8);
  TownScore a, b;
  score(town, straight, find_buildings(straight, straight.all(), {}).buildings, a);
  score(turned, other, find_buildings(other, other.all(), {}).buildings, b);
  EXPECT_EQ(a.matched, b.matched);
  EXPECT_NEAR(a.mean_iou(), b.mean_iou(), 0.02);
  EXPECT_NEAR(a.area / a.matched, b.area / b.matched, 0.02);
  EXPECT_NEAR(a.corner_rms(), b.corner_rms(), 0.15);
}

/// Four flat wings around a court of 10 m.
MadeTown court() {
  MadeTown town{.side = 60};
  const auto wing = [](double x, double y, double length, double width) {
    return Wing{{x, y}, length, width, Roof::flat, 8, 0};
  };
  town.houses.push_back({{30, 30},
                         0.2,
                         {wing(0, 9, 26, 8), wing(0, -9, 26, 8), wing(9, 0, 8, 12), wing(-9, 0, 8, 12)},
                         {{-13, -13}, {13, -13}, {13, 13}, {-13, 13}}});
  return town;
}

TEST(FindBuildingsOfPoints, CourtyardsAreHoles) {
  const auto found = find_in(court(), {.density = 8}, 1);
  ASSERT_EQ(found.buildings.size(), 1U);
  ASSERT_EQ(found.buildings[0].outline.holes.size(), 1U);
  EXPECT_NEAR(found.buildings[0].area, 26 * 26 - 100, 20);
  EXPECT_NEAR(ring_area(found.buildings[0].outline.holes[0].vertices), -100, 12);
  EXPECT_EQ(found.buildings[0].roof, RoofKind::flat);
}

TEST(FindBuildingsOfPoints, WhatIsNoBuildingIsCountedByReason) {
  const auto wide = find_in(court(), {.density = 8}, 1, {.max_extent = 25});
  EXPECT_TRUE(wide.buildings.empty());
  EXPECT_EQ(wide.rejected.at("wider than max_extent"), 1);
  const auto large = find_in(court(), {.density = 8}, 1, {.min_area = 2000});
  EXPECT_TRUE(large.buildings.empty());
  EXPECT_EQ(large.rejected.at("smaller than min_area"), 1);
  MadeTown edge{.side = 40};
  edge.houses.push_back(rectangle({2, 20}, 0, 12, 8, Roof::flat, 5, 0));  // half of it beyond the survey
  const auto cut = find_in(edge, {.density = 8}, 1);
  EXPECT_TRUE(cut.buildings.empty());
  EXPECT_EQ(cut.rejected.at("cut by the edge of the survey"), 1);
  EXPECT_TRUE(find_in({.side = 30}, {.density = 4}, 1).buildings.empty());
}

TEST(FindBuildingsOfPoints, ClassifiedVegetationIsNone) {
  const MadeTown town = court();
  auto returns = scan_town(town, {.density = 8}, 1);
  for (TownReturn& p : returns)
    if (p.classification != 2) p.classification = 5;
  const TownCanopy canopy(town, returns, 8);
  EXPECT_TRUE(find_buildings(canopy, canopy.all(), {}).buildings.empty());
}

TEST(FindBuildingsInRasters, HousesAreFoundAndCrownsAreNot) {
  constexpr double kCell = 0.5;
  SyntheticCanopy forest = synthetic_forest(131, 240, 90, kCell);
  Grid<float> heights = forest.read({0, 0, 240, 240});
  const MadeTown town = made_town(131, 112);
  Random random(1, "raster");
  for (std::int64_t r = 0; r < 240; ++r)
    for (std::int64_t c = 0; c < 240; ++c) {
      double roof = 0;
      for (const House& h : town.houses)
        roof = std::max(roof, h.z({double(c) * kCell, 120 - double(r) * kCell}));
      if (roof > 0) heights(c, r) = float(roof + 0.05 * random.normal());
    }
  const SyntheticCanopy canopy(std::move(heights), kCell);
  const auto found = find_buildings(canopy, {0, 0, 240, 240}, {}),
             none = find_buildings(forest, {0, 0, 240, 240}, {});
  EXPECT_EQ(none.buildings.size(), 0U);
  int matched = 0;
  double iou = 0;
  for (const DetectedBuilding& b : found.buildings) {
    std::vector<Eigen::Vector2d> ring;
    for (const Eigen::Vector2d& v : b.outline.outer.vertices) ring.push_back(v + Eigen::Vector2d(0, 120));
    for (const House& h : town.houses)
      if (const double o = overlap(ring, h.outline()); o > 0.5) ++matched, iou += o;
  }
  std::printf("raster: %d of %zu houses, %zu found, IoU %.3f\n", matched, town.houses.size(),
              found.buildings.size(), iou / std::max(1, matched));
  EXPECT_GE(matched, int(0.9 * double(town.houses.size())));
  EXPECT_LE(int(found.buildings.size()) - matched, 1);
  EXPECT_GE(iou / matched, 0.85);
}

/// Forests measured by laser, without a house: every building is false.
TEST(FindBuildingsInRealForests, ThereAreFewOrNone) {
  const std::filesystem::path folder = std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/forest";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no data of real forests";
  std::size_t all = 0;
  for (const char* name : {"lidr/MixedConifer.las", "lidr/Megaplot.las", "lidr/Topography.las",
                           "neon/SJER_052.las", "spanner/ALS_Clip.laz"}) {
    const auto canopy = importers::import_canopy({.las = {(folder / name).string()}});
    const GridGeometry& grid = canopy->geometry();
    const Window whole{0, 0, grid.columns, grid.rows};
    const FoundBuildings found = find_buildings(*canopy, whole, {});
    const FoundPoles poles = find_poles(*canopy, whole, {});
    std::printf("%s: %.2f ha, %.1f first returns/m2, %zu buildings, %zu poles;", name,
                double(grid.cells()) * grid.where.dx * grid.where.dx / 1e4, canopy->point_density(),
                found.buildings.size(), poles.poles.size());
    for (const DetectedBuilding& b : found.buildings)
      std::printf(" %.0f m2 at %.0f %.0f (%.2f, pulses %.2f);", b.area, b.outline.outer.vertices[0].x(),
                  b.outline.outer.vertices[0].y(), b.confidence, b.penetration);
    for (const auto& [reason, count] : found.rejected) std::printf(" %d %s;", int(count), reason.c_str());
    std::printf("\n");
    all += found.buildings.size();
  }
  EXPECT_LE(all, 2U);
}

}  // namespace
}  // namespace waymark::test
