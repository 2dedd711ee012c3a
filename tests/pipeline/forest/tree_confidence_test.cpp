// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/tree_confidence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "pipeline/forest/find_trees.hpp"
#include "synthetic_canopy.hpp"
#include "workflows/training/treetop_training_data.hpp"

namespace waymark::test {
using namespace pipeline;
using namespace workflows;
namespace {

constexpr double kMaxCalibrationError = 0.08;  // calibration error
constexpr ForestType kTypes[] = {ForestType::conifer, ForestType::broadleaf, ForestType::mixed};

using Judge = decltype(&score_rough_forest);

void add(std::vector<ScoredTreetop>& all, Judge judge, std::uint64_t from, std::uint64_t to,
         ForestType type) {
  for (std::uint64_t seed = from; seed < to; ++seed)
    for (const ScoredTreetop& one : judge(seed, type)) all.push_back(one);
}

struct Calibration {
  std::size_t finds = 0;
  double right = 0, predicted = 0, brier = 0, brier_of_constant = 0, error = 0;
};

Calibration calibration(const std::vector<ScoredTreetop>& all) {
  Calibration c{.finds = all.size()};
  double predicted[10] = {}, right[10] = {};
  for (const ScoredTreetop& one : all) {
    const double truth = one.is_tree ? 1 : 0;
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
  std::vector<ScoredTreetop> all;
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

}  // namespace
}  // namespace waymark::test
