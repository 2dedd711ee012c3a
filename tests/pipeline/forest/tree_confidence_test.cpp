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

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr double kMaxCalibrationError = 0.08;  // calibration error
constexpr ForestType kTypes[] = {ForestType::conifer, ForestType::broadleaf, ForestType::mixed};

struct ScoredTop {
  TopEvidence evidence;
  double predicted = 0;
  bool tree = false;  ///< highest detection on its crown
};

/// Returns the detections in a canopy, except those within 5 m of its border. `is_tree` is called for each
/// detection in order of descending height.
std::vector<ScoredTop> score_tops(const SyntheticCanopy& canopy, ForestType type,
                                  const std::function<bool(const CanopyCell&)>& is_tree) {
  const GridGeometry& grid = canopy.geometry();
  const TreeSearch search{.forest = forest_preset(type), .crowns = false};
  const auto found = find_trees(canopy, canopy.all(), search);
  const CanopyWindow raw{canopy.all(), canopy.heights(), grid.where.dx, grid.where.dx};
  const CanopyWindow smooth = smooth_canopy(raw, search.forest.smoothing);
  std::vector<Treetop> tops;
  for (const DetectedTree& tree : found) tops.push_back({tree.top, smooth.at(tree.top)});
  std::vector<std::size_t> order(tops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return -tops[i].height; });
  const auto margin = static_cast<std::int64_t>(5 / grid.where.dx);
  std::vector<ScoredTop> all;
  for (const std::size_t i : order) {
    const auto [column, row] = tops[i].cell;
    const bool tree = is_tree(tops[i].cell);
    if (std::min({column, row, grid.columns - 1 - column, grid.rows - 1 - row}) >= margin)
      all.push_back({top_evidence(raw, smooth, tops, i), found[i].confidence, tree});
  }
  return all;
}

std::vector<ScoredTop> score_rough_forest(std::uint64_t seed, ForestType type) {
  const RoughForest forest = rough_forest(seed, type);
  std::set<std::int32_t> counted{-1};
  return score_tops(forest.canopy, type, [&](const CanopyCell& at) {
    return counted.insert(forest.tree(at.column, at.row)).second;
  });
}

/// A hectare of the testbed, with smooth, separate crowns. A detection is the nearest tree within 2.5 m
/// that no higher detection has taken.
std::vector<ScoredTop> score_testbed_forest(std::uint64_t seed, ForestType type) {
  Random random(seed, "forests for confidence");
  testbed::ForestModel law;
  law.width = law.height = 100;
  law.density = random.log_uniform(200, 1200);
  law.mean_dbh = 0.32 * std::sqrt(300 / law.density);
  law.conifers = type == ForestType::conifer ? 1 : type == ForestType::broadleaf ? 0 : 0.5;
  law.cell = random.bernoulli(0.5) ? 0.5 : 1;
  if (random.bernoulli(0.3)) law.pattern = "clustered";
  const Terrain flat(Grid<float>(4, 4, 0.0F), -225, 225, 150, 150);
  const testbed::SyntheticForest forest = testbed::plant_forest(law, flat, 0, 0, seed);
  const testbed::ForestRasters rasters =
      testbed::scan_forest(law, forest, flat, 0, 0, seed, [](std::span<const testbed::LaserReturn>) {});
  std::vector<char> predicted(forest.trees.size());
  return score_tops(SyntheticCanopy(rasters.chm, rasters.cell), type, [&](const CanopyCell& at) {
    double nearest = 2.5;
    std::size_t tree = predicted.size();
    for (std::size_t i = 0; i < predicted.size(); ++i) {
      const double x = rasters.x0 + static_cast<double>(at.column) * rasters.cell,
                   y = rasters.y0 - static_cast<double>(at.row) * rasters.cell;
      const double away = std::hypot(forest.trees[i].foot.x() - x, forest.trees[i].foot.y() - y);
      if (!predicted[i] && away < nearest) nearest = away, tree = i;
    }
    if (tree < predicted.size()) predicted[tree] = 1;
    return tree < predicted.size();
  });
}

using Judge = std::vector<ScoredTop> (*)(std::uint64_t seed, ForestType type);

void add(std::vector<ScoredTop>& all, Judge judge, std::uint64_t from, std::uint64_t to, ForestType type) {
  for (std::uint64_t seed = from; seed < to; ++seed)
    for (const ScoredTop& one : judge(seed, type)) all.push_back(one);
}

struct Calibration {
  std::size_t finds = 0;
  double right = 0, predicted = 0, brier = 0, brier_of_constant = 0, error = 0;
};

Calibration calibration(const std::vector<ScoredTop>& all) {
  Calibration c{.finds = all.size()};
  double predicted[10] = {}, right[10] = {};
  for (const ScoredTop& one : all) {
    const double truth = one.tree ? 1 : 0;
    const int bin = std::min(9, static_cast<int>(10 * one.predicted));
    predicted[bin] += one.predicted, right[bin] += truth;
    c.right += truth, c.predicted += one.predicted;
    c.brier += (one.predicted - truth) * (one.predicted - truth);
    c.brier_of_constant += (0.9 - truth) * (0.9 - truth);
  }
  for (int bin = 0; bin < 10; ++bin) c.error += std::abs(predicted[bin] - right[bin]);
  const auto n = static_cast<double>(all.size());
  c.right /= n, c.predicted /= n, c.brier /= n, c.brier_of_constant /= n, c.error /= n;
  return c;
}

Calibration told_of(const char* kind, Judge judge, std::uint64_t from, std::uint64_t to, ForestType type) {
  std::vector<ScoredTop> all;
  add(all, judge, from, to, type);
  const Calibration c = calibration(all);
  std::printf(
      "%s %s: %zu finds, %.3f are trees, predicted %.3f; Brier %.4f, of 0.9 for all %.4f; error %.3f\n", kind,
      forest_preset(type).name.c_str(), c.finds, c.right, c.predicted, c.brier, c.brier_of_constant, c.error);
  return c;
}

TEST(TreeConfidence, HoldsOnForestsItWasNotFittedTo) {
  for (const ForestType type : kTypes) {
    const Calibration rough = told_of("rough", score_rough_forest, 1000, 1020, type);
    EXPECT_LT(rough.brier, 0.75 * rough.brier_of_constant);
    EXPECT_LT(rough.error, kMaxCalibrationError);
    const Calibration testbed = told_of("testbed", score_testbed_forest, 80'000, 80'004, type);
    EXPECT_LT(testbed.error, kMaxCalibrationError);
  }
}

TEST(TreeConfidence, RivalsAreHigherTopsAndTheWayToThem) {
  CanopyWindow canopy{{10, 20, 7, 1}, Grid<float>(7, 1, 0), 0.5, 0.5};
  const float heights[] = {0, 9, 5, 4, 5, 7, 0};
  for (std::int64_t c = 0; c < 7; ++c) canopy.heights(c, 0) = heights[c];
  const std::vector<Treetop> tops{{{11, 20}, 9}, {{15, 20}, 7}};
  EXPECT_FALSE(top_evidence(canopy, canopy, tops, 0).has_rival);
  const TopEvidence lesser = top_evidence(canopy, canopy, tops, 1);
  EXPECT_TRUE(lesser.has_rival);
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
          .height = 20, .roughness = 0.2, .has_rival = true, .distance = distance, .drop = 0.05};
      const double predicted = tree_confidence(near, type);
      EXPECT_GT(predicted, before);
      before = predicted;
      TopEvidence deep = near, tall = near;
      deep.drop = 0.5, tall.height = 30;
      EXPECT_GE(tree_confidence(deep, type), predicted);
      EXPECT_LE(tree_confidence(tall, type), predicted);
      if (distance == 1) {
        EXPECT_LT(predicted, 0.5);
      }
    }
  }
}

TEST(TreeConfidence, DoesNotDependOnTilesOrCrowns) {
  const SyntheticCanopy canopy = synthetic_forest(7, 90, 40);
  TreeSearch search;
  search.forest.crowns.max_radius = 3;  // nearer than rivals are looked for
  const auto whole = find_trees(canopy, canopy.all(), search);
  for (const bool crowns : {false, true}) {
    search.crowns = crowns;
    std::map<std::pair<std::int64_t, std::int64_t>, double> in_parts;
    for (std::int64_t row = 0; row < 90; row += 30)
      for (std::int64_t column = 0; column < 90; column += 18)
        for (const DetectedTree& tree : find_trees(canopy, {column, row, 18, 30}, search))
          in_parts[{tree.top.column, tree.top.row}] = tree.confidence;
    ASSERT_EQ(in_parts.size(), whole.size());
    for (const DetectedTree& tree : whole)
      EXPECT_EQ(tree.confidence, in_parts.at(std::pair(tree.top.column, tree.top.row)));
  }
}

// Prints the coefficients of tree_confidence.cpp: logistic regression by Newton's steps, of each type
// the rough forests 0 to 119 and those of the testbed 70000 to 70039.
TEST(TreeConfidence, DISABLED_Fit) {
  using Vector = Eigen::Matrix<double, 6, 1>;
  for (const ForestType type : kTypes) {
    std::vector<ScoredTop> all;
    add(all, score_rough_forest, 0, 120, type);
    add(all, score_testbed_forest, 70'000, 70'040, type);
    Vector weights = Vector::Zero();
    for (int round = 0; round < 40; ++round) {
      Vector slope = -0.01 * weights;
      Eigen::Matrix<double, 6, 6> bend = 0.01 * Eigen::Matrix<double, 6, 6>::Identity();
      for (const ScoredTop& one : all) {
        const auto values = regression_terms(one.evidence);
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
}  // namespace waymark::test
