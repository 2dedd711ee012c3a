// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/prominence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "pipeline/terrain/cell_order.hpp"
#include "tests/pipeline/terrain/survey.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

// ---- the slow twin: everything by its definition
// ------------------------------------------------------------

struct Terrain {
  const MemoryDem& dem;
  double height(std::int64_t cell) const { return dem.heights().cells()[static_cast<std::size_t>(cell)]; }
  bool higher(std::int64_t a, std::int64_t b) const { return is_higher(height(a), a, height(b), b); }
  std::vector<std::int64_t> neighbours(std::int64_t cell) const {
    const auto& grid = dem.geometry();
    std::vector<std::int64_t> all;
    for (std::int64_t dr = -1; dr <= 1; ++dr)
      for (std::int64_t dc = -1; dc <= 1; ++dc) {
        std::int64_t c = cell % grid.columns + dc;
        const std::int64_t r = cell / grid.columns + dr;
        if (grid.wraps) c = (c + grid.columns) % grid.columns;
        if ((dc || dr) && dem.heights().contains(c, r) && height(grid.index(c, r)) != kNoHeight)
          all.push_back(grid.index(c, r));
      }
    return all;
  }
  bool touches_hidden(std::int64_t cell) const {
    const auto& grid = dem.geometry();
    for (std::int64_t dr = -1; dr <= 1; ++dr)
      for (std::int64_t dc = -1; dc <= 1; ++dc) {
        std::int64_t c = cell % grid.columns + dc;
        const std::int64_t r = cell / grid.columns + dr;
        if (grid.wraps) c = (c + grid.columns) % grid.columns;
        if (!dem.heights().contains(c, r)) {
          const bool over_pole = (r < 0 && grid.north_pole) || (r >= grid.rows && grid.south_pole);
          if (!over_pole) return true;
        } else if (height(grid.index(c, r)) == kNoHeight && dem.nodata_policy() != NodataPolicy::ocean) {
          return true;
        }
      }
    return false;
  }
  // Returns the island around `peak` at a water level just below `level`.
  std::set<std::int64_t> island(std::int64_t peak, std::int64_t level) const {
    std::set<std::int64_t> dry{peak};
    std::vector<std::int64_t> stack{peak};
    while (!stack.empty()) {
      const std::int64_t cell = stack.back();
      stack.pop_back();
      for (const std::int64_t n : neighbours(cell))
        if ((n == level || higher(n, level)) && dry.insert(n).second) stack.push_back(n);
    }
    return dry;
  }
};

std::vector<Summit> summits_by_definition(const MemoryDem& dem) {
  const Terrain terrain{dem};
  std::vector<std::int64_t> order;
  for (std::int64_t cell = 0; cell < dem.geometry().cells(); ++cell)
    if (terrain.height(cell) != kNoHeight) order.push_back(cell);
  std::ranges::sort(order, [&](auto a, auto b) { return terrain.higher(a, b); });

  std::vector<Summit> found;
  for (const std::int64_t peak : order) {
    Summit summit{.cell = peak, .height = terrain.height(peak)};
    double floor = 0, contact = kNoHeight;
    bool is_summit = true;
    std::set<std::int64_t> last{peak};
    for (const std::int64_t n : terrain.neighbours(peak)) is_summit &= terrain.higher(peak, n);
    if (!is_summit) continue;
    for (const std::int64_t level : order) {
      if (terrain.higher(level, peak)) continue;
      const auto dry = terrain.island(peak, level);
      const bool escaped = std::ranges::any_of(dry, [&](auto c) { return terrain.higher(c, peak); });
      if (escaped) {
        summit.saddle = level;
        summit.saddle_height = floor = terrain.height(level);
        summit.parent = *std::ranges::min_element(dry, [&](auto a, auto b) { return terrain.higher(a, b); });
        break;
      }
      last = dry;
    }
    for (const std::int64_t cell : last)
      if (terrain.touches_hidden(cell)) contact = std::max(contact, terrain.height(cell));
    summit.prominence = summit.height - floor;
    summit.prominence_low = summit.height - std::max(floor, contact);
    if (summit.prominence > 0) found.push_back(summit);
  }
  return found;
}

void PrintTo(const Summit& s, std::ostream* out) {
  *out << "{cell " << s.cell << " z " << s.height << " prom " << s.prominence << " low " << s.prominence_low
       << " saddle " << s.saddle << " parent " << s.parent << "}";
}

bool same(const Summit& a, const Summit& b) {
  const bool saddles =
      std::isnan(a.saddle_height) ? std::isnan(b.saddle_height) : a.saddle_height == b.saddle_height;
  return a.cell == b.cell && a.height == b.height && a.prominence == b.prominence &&
         a.prominence_low == b.prominence_low && a.saddle == b.saddle && a.parent == b.parent && saddles;
}

void expect_same(const std::vector<Summit>& a, const std::vector<Summit>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (same(a[i], b[i])) continue;
    std::ostringstream text;
    PrintTo(a[i], &text);
    text << " versus ";
    PrintTo(b[i], &text);
    FAIL() << text.str();
  }
}

std::vector<Summit> at_least(const std::vector<Summit>& summits, double prominence) {
  std::vector<Summit> kept;
  for (const Summit& s : summits)
    if (!(s.prominence < prominence)) kept.push_back(s);
  return kept;
}

// ---- pictures
// -----------------------------------------------------------------------------------------------

TEST(Prominence, TwinPeaksShareTheSaddle) {
  const MemoryDem dem(dem_art("0 0 0 0 0 0 0 / 0 9 5 4 5 7 0 / 0 0 0 0 0 0 0"));
  const auto summits = survey(dem, 64);
  ASSERT_EQ(summits.size(), 2u);
  EXPECT_EQ(summits[0].height, 9);
  EXPECT_EQ(summits[0].prominence, 9);
  EXPECT_EQ(summits[0].saddle, -1);
  EXPECT_EQ(summits[1].height, 7);
  EXPECT_EQ(summits[1].prominence, 3);
  EXPECT_EQ(summits[1].saddle, 10);
  EXPECT_EQ(summits[1].parent, summits[0].cell);
}

TEST(Prominence, DiagonalNeighboursAreConnected) {
  const MemoryDem dem(dem_art("9 0 0 / 0 6 0 / 0 0 8"));
  const auto summits = survey(dem, 64);
  ASSERT_EQ(summits.size(), 2u);
  EXPECT_EQ(summits[1].prominence, 2);
}

TEST(Prominence, APlateauIsOneSummit) {
  const MemoryDem dem(dem_art("1 1 1 1 1 / 1 5 1 5 1 / 1 5 5 5 1 / 1 1 1 1 1"));
  const auto summits = survey(dem, 64);
  ASSERT_EQ(summits.size(), 1u);
  EXPECT_EQ(summits[0].cell, 6);
}

TEST(Prominence, APlateauBelowAHigherCellIsNoSummit) {
  const MemoryDem dem(dem_art("1 1 1 1 1 / 5 5 5 5 6 / 1 1 1 1 1"));
  EXPECT_EQ(survey(dem, 64).size(), 1u);
}

TEST(Prominence, EachIslandOfAnOceanIsMeasuredFromTheBase) {
  const MemoryDem dem(dem_art("3 . -2 / . . . / 7 . ."));
  const auto sea = survey(dem, 64, 0, BasePolicy::sea);
  ASSERT_EQ(sea.size(), 2u);  // the piece below the sea has no prominence above it
  EXPECT_EQ(sea[0].prominence, 7);
  EXPECT_EQ(sea[1].prominence, 3);
  const auto lowest = survey(dem, 64, 0, BasePolicy::lowest);
  EXPECT_EQ(lowest[0].prominence, 9);
  const auto none = survey(dem, 64, 0, BasePolicy::none);
  ASSERT_EQ(none.size(), 3u);
  EXPECT_TRUE(std::isnan(none[0].prominence));
}

TEST(Prominence, AutomaticBaseIsTheLowestCellWhereAllGroundLiesBelowZero) {
  const MemoryDem mars(dem_art("-9 -9 -9 / -9 -2 -9 / -9 -9 -9"));
  const auto summits = survey(mars, 64, 0, BasePolicy::automatic);
  ASSERT_EQ(summits.size(), 1u);
  EXPECT_EQ(summits[0].prominence, 7);
}

TEST(Prominence, HiddenGroundBeyondTheEdgeLowersTheCertifiedBound) {
  const MemoryDem dem(dem_art("0 0 0 0 0 0 / 0 9 3 7 5 4 / 0 0 0 0 0 0"));
  const auto summits = survey(dem, 64);
  ASSERT_EQ(summits.size(), 2u);
  EXPECT_EQ(summits[1].prominence, 4);      // saddle at 3
  EXPECT_EQ(summits[1].prominence_low, 3);  // the ridge leaves the map at 4
}

TEST(Prominence, AVoidHidesGroundOnlyWhenItIsNotOcean) {
  const auto art = dem_art("0 0 0 0 0 0 0 / 0 9 3 7 5 . 0 / 0 0 0 0 0 0 0");
  EXPECT_EQ(survey(MemoryDem(art, {}, NodataPolicy::ocean), 64)[1].prominence_low, 4);
  EXPECT_EQ(survey(MemoryDem(art, {}, NodataPolicy::unknown), 64)[1].prominence_low, 2);
}

// The same in hundreds of metres: no sea lies beside a ridge at 500 m.
TEST(Prominence, AVoidInTheMountainsIsNoSea) {
  const auto art = dem_art("0 0 0 0 0 0 0 / 0 900 300 700 500 . 0 / 0 0 0 0 0 0 0");
  const auto ocean = survey(MemoryDem(art, {}, NodataPolicy::ocean), 64);
  EXPECT_EQ(ocean[1].prominence, 400);
  EXPECT_EQ(ocean[1].prominence_low, 200);
  const auto shore = dem_art("0 0 0 0 0 0 0 / 0 900 300 700 90 . 0 / 0 0 0 0 0 0 0");
  EXPECT_EQ(survey(MemoryDem(shore, {}, NodataPolicy::ocean), 64)[1].prominence_low, 400);
}

TEST(Prominence, NoSeaLiesOnMars) {
  const MemoryDem mars(dem_art("-9 -9 -9 -9 -9 -9 / -9 -1 -7 -3 . -9 / -9 -9 -9 -9 -9 -9"),
                       {Crs::from_text("IAU_2015:49900"), 0, 0, 1, -1});
  EXPECT_EQ(survey(mars, 64, 0, BasePolicy::lowest)[1].prominence_low, 0);
}

TEST(Prominence, AGlobalGridContinuesAcrossItsSeam) {
  const auto art = dem_art("0 0 0 0 0 0 / 5 3 0 0 9 6 / 0 0 0 0 0 0");
  EXPECT_EQ(survey(MemoryDem(art), 64).size(), 2u);
  EXPECT_EQ(survey(MemoryDem(art, {}, NodataPolicy::ocean, true), 64).size(), 1u);
}

// ---- against the twin, on random nasty terrain
// ----------------------------------------------------------------

TEST(Prominence, MatchesTheDefinition) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    const bool wraps = seed % 5 == 0;
    const auto policy = seed % 2 ? NodataPolicy::unknown : NodataPolicy::ocean;
    const MemoryDem dem(random_terrain(seed, 4 + seed % 7, 2 + seed % 6), {}, policy, wraps, seed % 10 == 0);
    SCOPED_TRACE("seed " + std::to_string(seed));
    ASSERT_NO_FATAL_FAILURE(expect_same(survey(dem, 64), summits_by_definition(dem)));
  }
}

TEST(Prominence, DoesNotDependOnTiles) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const auto policy = seed % 2 ? NodataPolicy::unknown : NodataPolicy::ocean;
    const MemoryDem dem(random_terrain(seed, 12 + seed % 19, 9 + seed % 13), {}, policy, seed % 5 == 0);
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto whole = survey(dem, 1000);
    for (const std::int64_t side : {1, 2, 3, 5, 8})
      ASSERT_NO_FATAL_FAILURE(expect_same(survey(dem, side), whole)) << "tiles of " << side;
  }
}

TEST(Prominence, PruningInTilesChangesNothingAboveTheThreshold) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const auto policy = seed % 2 ? NodataPolicy::unknown : NodataPolicy::ocean;
    const MemoryDem dem(random_terrain(seed, 12 + seed % 19, 9 + seed % 13), {}, policy, seed % 5 == 0);
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto all = survey(dem, 1000);
    for (const double least : {1.0, 3.0, 8.0})
      for (const std::int64_t side : {3, 7, 1000})
        ASSERT_NO_FATAL_FAILURE(expect_same(survey(dem, side, least), at_least(all, least)))
            << "tiles of " << side << ", at least " << least;
  }
}

TEST(Prominence, MergingByLevelsChangesNothing) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const auto policy = seed % 2 ? NodataPolicy::unknown : NodataPolicy::ocean;
    const MemoryDem dem(random_terrain(seed, 12 + seed % 19, 9 + seed % 13), {}, policy, seed % 5 == 0);
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto all = survey(dem, 1000);
    for (const double least : {0.0, 1.0, 3.0, 8.0})
      for (const std::int64_t side : {1, 2, 3, 5, 8, 40})
        ASSERT_NO_FATAL_FAILURE(expect_same(survey_by_levels(dem, side, least), at_least(all, least)))
            << "tiles of " << side << ", at least " << least;
  }
}

// 400 tiles have 30,000 border cells; the merged tree has none, and few summits.
TEST(Prominence, MergingByLevelsForgetsTheTiles) {
  const MemoryDem dem(random_terrain(3, 400, 400));
  TreePyramid levels(dem.geometry());
  std::size_t tile_nodes = 0;
  for (const Window& window : tiles_of(dem.geometry(), 20)) {
    const auto tile = tree_of(dem, window, 100);
    tile_nodes += tile->nodes.size();
    levels.add(tile);
  }
  EXPECT_TRUE(levels.whole()->border.empty());
  EXPECT_EQ(levels.whole()->cells, tree_of(dem, {0, 0, 400, 400}, 100)->cells);
  EXPECT_EQ(levels.whole()->maxima, tree_of(dem, {0, 0, 400, 400}, 100)->maxima);
  EXPECT_LT(20 * levels.whole()->nodes.size(), tile_nodes);
}

TEST(Prominence, PruningKeepsATileSmall) {
  const MemoryDem dem(random_terrain(3, 200, 200));
  const auto all = tree_of(dem, {0, 0, 200, 200}, 0), pruned = tree_of(dem, {0, 0, 200, 200}, 100);
  EXPECT_GT(all->nodes.size(), 2000u);
  EXPECT_LT(pruned->nodes.size(), 400u);  // exposed by the edge of the grid: at most half of 4 x 200 cells
}

TEST(Prominence, AddingAConstantChangesNoProminence) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    auto terrain = random_terrain(seed, 15, 11);
    const auto before = survey(MemoryDem(terrain), 4);
    for (double& cell : terrain.cells()) cell += 64;
    const auto after = survey(MemoryDem(terrain), 4);
    for (const Summit& s : before) {
      if (s.saddle < 0) continue;
      const auto same_summit = std::ranges::find(after, s.cell, &Summit::cell);
      ASSERT_NE(same_summit, after.end());
      EXPECT_NEAR(same_summit->prominence, s.prominence, 1e-12);
    }
  }
}

TEST(Prominence, ATileThatIsMissingIsNoticed) {
  const MemoryDem dem(random_terrain(1, 20, 20));
  const auto tiles = tiles_of(dem.geometry(), 10);
  std::vector<std::shared_ptr<const DivideTree>> trees;
  for (std::size_t i = 0; i + 1 < tiles.size(); ++i) trees.push_back(tree_of(dem, tiles[i], 0));
  EXPECT_THROW(join_divide_trees(trees, 0), std::logic_error);
}

}  // namespace
}  // namespace waymark::test
