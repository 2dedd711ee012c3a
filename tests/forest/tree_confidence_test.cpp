// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/tree_confidence.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "pipeline/forest/find_trees.hpp"
#include "rough_forest.hpp"
#include "testbed/forest/forest_scan.hpp"

namespace waymark::testing {
namespace {

constexpr double kWorst = 0.08;  // calibration error
constexpr ForestType kTypes[] = {ForestType::conifer, ForestType::broadleaf, ForestType::mixed};

struct Judged {
  TopEvidence evidence;
  double told = 0;
  bool tree = false;  ///< the highest find on its crown
};

/// The finds in a canopy, but those within 5 m of its border, which trees could share with what is beyond.
/// `is_tree` tells of each find, the highest first, whether it is a tree.
std::vector<Judged> judged(const MadeCanopy& canopy, ForestType type,
                           const std::function<bool(const CanopyCell&)>& is_tree) {
  const GridGeometry& grid = canopy.geometry();
  const TreeSearch search{.forest = forest_preset(type), .crowns = false};
  const auto found = find_trees(canopy, canopy.all(), search);
  const CanopyWindow raw{canopy.all(), canopy.heights(), grid.where.dx, grid.where.dx};
  const CanopyWindow smooth = smoothed(raw, search.forest.smoothing);
  std::vector<Treetop> tops;
  for (const FoundTree& tree : found) tops.push_back({tree.top, smooth.at(tree.top)});
  std::vector<std::size_t> order(tops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return -tops[i].height; });
  const auto margin = static_cast<std::int64_t>(5 / grid.where.dx);
  std::vector<Judged> all;
  for (const std::size_t i : order) {
    const auto [column, row] = tops[i].cell;
    const bool tree = is_tree(tops[i].cell);
    if (std::min({column, row, grid.columns - 1 - column, grid.rows - 1 - row}) >= margin)
      all.push_back({evidence_of(raw, smooth, tops, i), found[i].confidence, tree});
  }
  return all;
}

std::vector<Judged> judged_rough(std::uint64_t seed, ForestType type) {
  const RoughForest forest = rough_forest(seed, type);
  std::set<std::int32_t> told{-1};
  return judged(forest.canopy, type,
                [&](const CanopyCell& at) { return told.insert(forest.tree(at.column, at.row)).second; });
}

/// A hectare of the testbed, whose crowns are smooth and stand apart. A find is the nearest tree within 2.5 m
/// that no higher find is.
std::vector<Judged> judged_testbed(std::uint64_t seed, ForestType type) {
  Random random(seed, "forests for confidence");
  ForestLaw law;
  law.width = law.height = 100;
  law.density = random.log_uniform(200, 1200);
  law.mean_dbh = 0.32 * std::sqrt(300 / law.density);
  law.conifers = type == ForestType::conifer ? 1 : type == ForestType::broadleaf ? 0 : 0.5;
  law.cell = random.chance(0.5) ? 0.5 : 1;
  if (random.chance(0.3)) law.pattern = "clustered";
  const Terrain flat(Grid<float>(4, 4, 0.0F), -225, 225, 150, 150);
  const MadeForest forest = plant_forest(law, flat, 0, 0, seed);
  const ForestRasters rasters =
      scan_forest(law, forest, flat, 0, 0, seed, [](std::span<const LaserReturn>) {});
  std::vector<char> told(forest.trees.size());
  return judged(MadeCanopy(rasters.chm, rasters.cell), type, [&](const CanopyCell& at) {
    double nearest = 2.5;
    std::size_t tree = told.size();
    for (std::size_t i = 0; i < told.size(); ++i) {
      const double x = rasters.x0 + static_cast<double>(at.column) * rasters.cell,
                   y = rasters.y0 - static_cast<double>(at.row) * rasters.cell;
      const double away = std::hypot(forest.trees[i].foot.x() - x, forest.trees[i].foot.y() - y);
      if (!told[i] && away < nearest) nearest = away, tree = i;
    }
    if (tree < told.size()) told[tree] = 1;
    return tree < told.size();
  });
}

using Judge = std::vector<Judged> (*)(std::uint64_t seed, ForestType type);

void add(std::vector<Judged>& all, Judge judge, std::uint64_t from, std::uint64_t to, ForestType type) {
  for (std::uint64_t seed = from; seed < to; ++seed)
    for (const Judged& one : judge(seed, type)) all.push_back(one);
}

struct Calibration {
  std::size_t finds = 0;
  double right = 0, told = 0, brier = 0, brier_of_constant = 0, error = 0;
};

Calibration calibration(const std::vector<Judged>& all) {
  Calibration c{.finds = all.size()};
  double told[10] = {}, right[10] = {};
  for (const Judged& one : all) {
    const double truth = one.tree ? 1 : 0;
    const int bin = std::min(9, static_cast<int>(10 * one.told));
    told[bin] += one.told, right[bin] += truth;
    c.right += truth, c.told += one.told;
    c.brier += (one.told - truth) * (one.told - truth);
    c.brier_of_constant += (0.9 - truth) * (0.9 - truth);
  }
  for (int bin = 0; bin < 10; ++bin) c.error += std::abs(told[bin] - right[bin]);
  const auto n = static_cast<double>(all.size());
  c.right /= n, c.told /= n, c.brier /= n, c.brier_of_constant /= n, c.error /= n;
  return c;
}

Calibration told_of(const char* kind, Judge judge, std::uint64_t from, std::uint64_t to, ForestType type) {
  std::vector<Judged> all;
  add(all, judge, from, to, type);
  const Calibration c = calibration(all);
  std::printf("%s %s: %zu finds, %.3f are trees, told %.3f; Brier %.4f, of 0.9 for all %.4f; error %.3f\n",
              kind, forest_preset(type).name.c_str(), c.finds, c.right, c.told, c.brier, c.brier_of_constant,
              c.error);
  return c;
}

TEST(TreeConfidence, HoldsOnForestsItWasNotFittedTo) {
  for (const ForestType type : kTypes) {
    const Calibration rough = told_of("rough", judged_rough, 1000, 1020, type);
    EXPECT_LT(rough.brier, 0.75 * rough.brier_of_constant);
    EXPECT_LT(rough.error, kWorst);
    const Calibration testbed = told_of("testbed", judged_testbed, 80'000, 80'004, type);
    EXPECT_LT(testbed.error, kWorst);
  }
}

TEST(TreeConfidence, RivalsAreHigherTopsAndTheWayToThem) {
  CanopyWindow canopy{{10, 20, 7, 1}, Grid<float>(7, 1, 0), 0.5, 0.5};
  const float heights[] = {0, 9, 5, 4, 5, 7, 0};
  for (std::int64_t c = 0; c < 7; ++c) canopy.heights(c, 0) = heights[c];
  const std::vector<Treetop> tops{{{11, 20}, 9}, {{15, 20}, 7}};
  EXPECT_FALSE(evidence_of(canopy, canopy, tops, 0).rivalled);
  const TopEvidence lesser = evidence_of(canopy, canopy, tops, 1);
  EXPECT_TRUE(lesser.rivalled);
  EXPECT_EQ(lesser.distance, 2);
  EXPECT_DOUBLE_EQ(lesser.drop, 3.0 / 7);
  EXPECT_EQ(lesser.roughness, 0);
}

TEST(TreeConfidence, NearAndShallowTopsAreDoubted) {
  for (const ForestType type : kTypes) {
    EXPECT_GT(tree_confidence({.height = 20, .roughness = 0.2}, type), 0.95);
    double before = 0;
    for (const double distance : {1.0, 2.0, 3.0, 5.0}) {
      const TopEvidence near{
          .height = 20, .roughness = 0.2, .rivalled = true, .distance = distance, .drop = 0.05};
      const double told = tree_confidence(near, type);
      EXPECT_GT(told, before);
      before = told;
      TopEvidence deep = near, tall = near;
      deep.drop = 0.5, tall.height = 30;
      EXPECT_GE(tree_confidence(deep, type), told);
      EXPECT_LE(tree_confidence(tall, type), told);
      if (distance == 1) {
        EXPECT_LT(told, 0.5);
      }
    }
  }
}

TEST(TreeConfidence, DoesNotDependOnTilesOrCrowns) {
  const MadeCanopy canopy = made_forest(7, 90, 40);
  TreeSearch search;
  search.forest.crowns.max_radius = 3;  // nearer than rivals are looked for
  const auto whole = find_trees(canopy, canopy.all(), search);
  for (const bool crowns : {false, true}) {
    search.crowns = crowns;
    std::map<std::pair<std::int64_t, std::int64_t>, double> in_parts;
    for (std::int64_t row = 0; row < 90; row += 30)
      for (std::int64_t column = 0; column < 90; column += 18)
        for (const FoundTree& tree : find_trees(canopy, {column, row, 18, 30}, search))
          in_parts[{tree.top.column, tree.top.row}] = tree.confidence;
    ASSERT_EQ(in_parts.size(), whole.size());
    for (const FoundTree& tree : whole)
      EXPECT_EQ(tree.confidence, in_parts.at(std::pair(tree.top.column, tree.top.row)));
  }
}

// Prints the coefficients of tree_confidence.cpp: logistic regression by Newton's steps, of each type
// the rough forests 0 to 119 and those of the testbed 70000 to 70039.
TEST(TreeConfidence, DISABLED_Fit) {
  using Vector = Eigen::Matrix<double, 6, 1>;
  for (const ForestType type : kTypes) {
    std::vector<Judged> all;
    add(all, judged_rough, 0, 120, type);
    add(all, judged_testbed, 70'000, 70'040, type);
    Vector weights = Vector::Zero();
    for (int round = 0; round < 40; ++round) {
      Vector slope = -0.01 * weights;
      Eigen::Matrix<double, 6, 6> bend = 0.01 * Eigen::Matrix<double, 6, 6>::Identity();
      for (const Judged& one : all) {
        const auto values = terms_of(one.evidence);
        const Vector terms = Eigen::Map<const Vector>(values.data());
        const double p = 1 / (1 + std::exp(-weights.dot(terms)));
        slope += ((one.tree ? 1 : 0) - p) * terms;
        bend += p * (1 - p) * terms * terms.transpose();
      }
      weights += bend.ldlt().solve(slope);
    }
    std::printf("%s, %zu finds: {", forest_preset(type).name.c_str(), all.size());
    for (int i = 0; i < 6; ++i) std::printf("%s%.3f", i ? ", " : "", weights[i]);
    std::printf("}\n");
  }
}

}  // namespace
}  // namespace waymark::testing
