// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <map>
#include <set>

#include "pipeline/forest/find_trees.hpp"
#include "pipeline/terrain/prominence.hpp"
#include "synthetic_canopy.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using Cells = std::set<std::pair<std::int64_t, std::int64_t>>;

// The definition, with prominence by the mountain-top code.
Cells tops_by_definition(const CanopyWindow& smooth, const TreetopRules& rules) {
  const std::int64_t columns = smooth.heights.columns(), rows = smooth.heights.rows();
  GridGeometry grid;
  grid.columns = columns, grid.rows = rows;
  HeightWindow heights(columns + 2, rows + 2, kNoHeight);
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t c = 0; c < columns; ++c)
      if (smooth.heights(c, r) != kNoCanopy)
        heights(c + 1, r + 1) = static_cast<double>(smooth.heights(c, r));
  const auto tree = std::make_shared<const DivideTree>(
      build_divide_tree(heights, {0, 0, columns, rows}, grid, {.min_prominence = 0}));
  const std::vector all{tree};
  std::map<std::int64_t, double> prominence;
  for (const Summit& s : join_divide_trees(all, 0, BasePolicy::none))
    prominence[s.cell] = std::isnan(s.prominence) ? 1e9 : s.prominence;
  Cells tops;
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t c = 0; c < columns; ++c) {
      const float h = smooth.heights(c, r);
      if (h == kNoCanopy || !(h >= rules.min_height)) continue;
      const auto own = prominence.find(r * columns + c);
      if (own == prominence.end() || own->second < rules.prominence) continue;
      bool isolated = true;
      for (std::int64_t j = 0; j < rows; ++j)
        for (std::int64_t i = 0; i < columns; ++i) {
          const float other = smooth.heights(i, j);
          const bool higher = other > h || (other == h && j * columns + i < r * columns + c);
          const double away = std::hypot(static_cast<double>(i - c) * smooth.cell_width,
                                         static_cast<double>(j - r) * smooth.cell_height);
          isolated = isolated && !(higher && away <= rules.isolation(h));
        }
      if (isolated) tops.insert({c, r});
    }
  return tops;
}

Cells cells_of(const std::vector<Treetop>& tops) {
  Cells cells;
  for (const Treetop& t : tops) cells.insert({t.cell.column, t.cell.row});
  return cells;
}

TEST(Treetops, MatchTheDefinition) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SyntheticCanopy canopy = synthetic_forest(seed, 18, 5);  // 9 m: nothing is out of kProminenceReach
    CanopyWindow window{canopy.all(), canopy.heights(), 0.45, 0.5};
    if (seed % 2)  // a few levels only, so plateaus abound
      for (float& h : window.heights.cells()) h = h == kNoCanopy ? h : std::round(h / 4) * 4;
    TreetopRules rules{.min_height = 2, .isolation_base = 0.5, .isolation_slope = 0.05, .prominence = 0.3};
    const RulesAt at = [&](const CanopyCell&) -> const TreetopRules& { return rules; };
    ASSERT_EQ(cells_of(find_treetops(window, window.cells, at)), tops_by_definition(window, rules))
        << "seed " << seed;
  }
}

TEST(Treetops, AFlatCrownHasOne) {
  CanopyWindow window{{0, 0, 30, 30}, Grid<float>(30, 30, 0), 0.5, 0.5};
  for (std::int64_t r = 5; r < 25; ++r)
    for (std::int64_t c = 5; c < 25; ++c) window.heights(c, r) = 12;
  const TreetopRules rules;
  const auto tops =
      find_treetops(window, window.cells, [&](const CanopyCell&) -> const TreetopRules& { return rules; });
  EXPECT_EQ(tops.size(), 1U);
}

TEST(Smoothing, IsTheSameInEveryWindow) {
  const SyntheticCanopy canopy = synthetic_forest(3, 80, 60);
  const auto smooth_in = [&](const Window& w) { return smooth_canopy({w, canopy.read(w), 0.5, 0.5}, 0.6); };
  const CanopyWindow whole = smooth_in(canopy.all());
  const std::int64_t reach = smoothing_reach(0.6, 0.5);
  const CanopyWindow part = smooth_in({20, 10, 40, 50});
  for (std::int64_t r = 10 + reach; r < 60 - reach; ++r)
    for (std::int64_t c = 20 + reach; c < 60 - reach; ++c) ASSERT_EQ(part.at({c, r}), whole.at({c, r}));
}

TEST(Smoothing, KeepsALevelAndItsHoles) {
  CanopyWindow window{{0, 0, 9, 9}, Grid<float>(9, 9, 7), 1, 1};
  window.heights(4, 4) = kNoCanopy;
  const CanopyWindow smooth = smooth_canopy(window, 1);
  EXPECT_EQ(smooth.heights(4, 4), kNoCanopy);
  EXPECT_NEAR(smooth.heights(4, 3), 7, 1e-5);
  EXPECT_NEAR(smooth.heights(0, 0), 7, 1e-5);
}

bool same(const DetectedTree& a, const DetectedTree& b) {
  return a.top == b.top && a.height == b.height && a.crown.cells == b.crown.cells &&
         a.crown.ring == b.crown.ring;
}

TEST(Trees, DoNotDependOnTiles) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const SyntheticCanopy canopy = synthetic_forest(seed, 260, 500, seed % 2 ? 1.0 : 0.5);
    TreeSearch search;
    if (seed > 1) search.forest = forest_preset("broadleaf");
    const auto whole = find_trees(canopy, canopy.all(), search);
    ASSERT_GT(whole.size(), 50U);
    for (const std::int64_t side : {37, 100}) {
      std::vector<DetectedTree> tiled;
      for (std::int64_t row = 0; row < 260; row += side)
        for (std::int64_t column = 0; column < 260; column += side)
          for (DetectedTree& tree : find_trees(
                   canopy, {column, row, std::min(side, 260 - column), std::min(side, 260 - row)}, search))
            tiled.push_back(std::move(tree));
      std::sort(tiled.begin(), tiled.end(), [](const DetectedTree& a, const DetectedTree& b) {
        return std::pair(a.top.row, a.top.column) < std::pair(b.top.row, b.top.column);
      });
      ASSERT_EQ(tiled.size(), whole.size());
      for (std::size_t i = 0; i < whole.size(); ++i)
        ASSERT_TRUE(same(tiled[i], whole[i])) << seed << " " << side;
    }
  }
}

double area_of(const std::vector<CanopyCell>& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const CanopyCell &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += static_cast<double>(a.column * b.row - b.column * a.row);
  }
  return -twice / 2;  // rows run down, so counter-clockwise on the map is negative here
}

TEST(Crowns, OutlinesEncloseTheirCellsOnce) {
  const SyntheticCanopy canopy = synthetic_forest(11, 150, 200);
  for (const DetectedTree& tree : find_trees(canopy, canopy.all(), {})) {
    ASSERT_GE(tree.crown.cells, 1);
    EXPECT_DOUBLE_EQ(area_of(tree.crown.ring), static_cast<double>(tree.crown.cells));
    std::set<std::pair<std::int64_t, std::int64_t>> corners;
    for (const CanopyCell& c : tree.crown.ring) corners.insert({c.column, c.row});
    EXPECT_EQ(corners.size(), tree.crown.ring.size()) << "a ring that meets itself";
  }
}

TEST(Crowns, FillHolesAndCutCorners) {
  Grid<std::uint8_t> inside(4, 3, 1);
  inside(1, 1) = 0;                 // a hole
  inside(3, 0) = inside(3, 2) = 0;  // corners
  const Outline outline = outline_of(inside, 10, 20);
  EXPECT_EQ(outline.cells, 10);
  EXPECT_EQ(outline.ring.size(), 8U);
  EXPECT_EQ(outline.ring.front(), (CanopyCell{10, 20}));
}

TEST(Crowns, MayBeWiderThanTall) {
  Grid<float> heights(80, 80, 0);
  for (std::int64_t r = 0; r < 80; ++r)
    for (std::int64_t c = 0; c < 80; ++c) {
      const double away = std::hypot(static_cast<double>(c - 40), static_cast<double>(r - 40)) * 0.5;
      if (away < 5.5) heights(c, r) = static_cast<float>(7 - 0.1 * away * away);
    }
  const SyntheticCanopy oak(std::move(heights));
  const auto trees = find_trees(oak, oak.all(), {.forest = forest_preset("broadleaf")});
  ASSERT_EQ(trees.size(), 1U);
  EXPECT_NEAR(trees[0].height, 7, 0.1);
  EXPECT_NEAR(trees[0].crown_diameter, 11, 0.5);
}

TEST(Crowns, OfTwoTreesMeetInTheSaddle) {
  Grid<float> heights(60, 30, 0);
  for (std::int64_t r = 0; r < 30; ++r)
    for (std::int64_t c = 0; c < 60; ++c)
      for (const std::int64_t middle : {20, 35}) {
        const double away = std::hypot(static_cast<double>(c - middle), static_cast<double>(r - 15)) * 0.5;
        heights(c, r) = std::max(heights(c, r), static_cast<float>(20 - 2.5 * away));
      }
  const SyntheticCanopy pair(std::move(heights));
  const auto trees = find_trees(pair, pair.all(), {.forest = forest_preset("conifer")});
  ASSERT_EQ(trees.size(), 2U);
  EXPECT_EQ(trees[0].top, (CanopyCell{20, 15}));
  for (const CanopyCell& corner : trees[0].crown.ring) EXPECT_LE(corner.column, 29);  // the saddle is at 27.5
}

}  // namespace
}  // namespace waymark::test
