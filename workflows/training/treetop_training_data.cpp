// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/treetop_training_data.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <span>

#include "core/random.hpp"
#include "core/solve.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/forest/find_trees.hpp"
#include "pipeline/forest/tree_confidence.hpp"
#include "testbed/forest/forest_scan.hpp"
#include "workflows/training/rough_forest.hpp"

namespace waymark::workflows {
namespace {

/// Detected treetop and whether it is a separate tree.
struct TreetopExample {
  pipeline::TopEvidence evidence;
  bool is_tree = false;
};

/// Fits the coefficients of one type of forest: logistic regression by 40 Newton steps, with a ridge of 0.01.
/// They are rounded to three decimals, which makes them independent of the order of sums.
pipeline::TreetopTerms fit_tree_confidence(std::span<const TreetopExample> examples) {
  using Vector = Eigen::Matrix<double, 6, 1>;
  constexpr double kRidge = 0.01;
  Vector weights = Vector::Zero();
  for (int round = 0; round < 40; ++round) {
    Vector slope = -kRidge * weights;
    Eigen::Matrix<double, 6, 6> curvature = kRidge * Eigen::Matrix<double, 6, 6>::Identity();
    for (const TreetopExample& one : examples) {
      const pipeline::TreetopTerms values = pipeline::regression_terms(one.evidence);
      const Vector terms = Eigen::Map<const Vector>(values.data());
      const double p = 1 / (1 + std::exp(-weights.dot(terms)));
      slope += ((one.is_tree ? 1 : 0) - p) * terms;
      curvature += p * (1 - p) * terms * terms.transpose();
    }
    weights += solve_symmetric(curvature, slope);
  }
  pipeline::TreetopTerms rounded{};
  for (std::size_t i = 0; i < rounded.size(); ++i)
    rounded[i] = std::round(1000 * weights[static_cast<Eigen::Index>(i)]) / 1000;
  return rounded;
}

constexpr std::uint64_t kFirstTestbedForest = 70'000;  // seed

/// Returns the detections in a canopy, except those within 5 m of its border. `is_tree` is called for each
/// detection in order of descending height.
std::vector<ScoredTreetop> score_tops(const SyntheticCanopy& canopy, ForestType type,
                                      const std::function<bool(const pipeline::CanopyCell&)>& is_tree) {
  const GridGeometry& grid = canopy.geometry();
  const pipeline::TreeSearch search{.forest = pipeline::forest_preset(type), .crowns = false};
  const auto found = pipeline::find_trees(canopy, canopy.all(), search);
  const pipeline::CanopyWindow raw{canopy.all(), canopy.heights(), grid.where.dx, grid.where.dx};
  const pipeline::CanopyWindow smooth = pipeline::smooth_canopy(raw, search.forest.smoothing);
  std::vector<pipeline::Treetop> tops;
  for (const pipeline::DetectedTree& tree : found) tops.push_back({tree.top, smooth.at(tree.top)});
  std::vector<std::size_t> order(tops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return -tops[i].height; });
  const auto margin = static_cast<std::int64_t>(5 / grid.where.dx);
  std::vector<ScoredTreetop> all;
  for (const std::size_t i : order) {
    const auto [column, row] = tops[i].cell;
    const bool tree = is_tree(tops[i].cell);
    if (std::min({column, row, grid.columns - 1 - column, grid.rows - 1 - row}) >= margin)
      all.push_back({pipeline::top_evidence(raw, smooth, tops, i), found[i].confidence, tree});
  }
  return all;
}

}  // namespace

std::vector<ScoredTreetop> score_rough_forest(std::uint64_t seed, ForestType type) {
  const RoughForest forest = rough_forest(seed, type);
  std::set<std::int32_t> counted{-1};
  return score_tops(forest.canopy, type, [&](const pipeline::CanopyCell& at) {
    return counted.insert(forest.tree(at.column, at.row)).second;
  });
}

std::vector<ScoredTreetop> score_testbed_forest(std::uint64_t seed, ForestType type) {
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
  return score_tops(SyntheticCanopy(rasters.chm, rasters.cell), type, [&](const pipeline::CanopyCell& at) {
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

pipeline::TreeConfidenceModel train_tree_confidence(int forests, int threads,
                                                    const pipeline::ProgressListener& progress) {
  constexpr ForestType kTypes[] = {ForestType::conifer, ForestType::broadleaf, ForestType::mixed};
  const auto rough = static_cast<std::size_t>(forests), count = rough + (rough + 2) / 3;
  pipeline::ProgressMeter meter(progress, "train trees", static_cast<std::int64_t>(3 * count));
  pipeline::TreeConfidenceModel model;
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  std::size_t tops = 0;
  for (std::size_t type = 0; type < 3; ++type) {
    std::vector<std::vector<ScoredTreetop>> parts(count);
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        parts[i] = i < rough ? score_rough_forest(i, kTypes[type])
                             : score_testbed_forest(kFirstTestbedForest + i - rough, kTypes[type]);
        meter.add(1);
      });
    });
    std::vector<TreetopExample> examples;
    for (const auto& part : parts)
      for (const ScoredTreetop& top : part) examples.push_back({top.evidence, top.is_tree});
    tops += examples.size();
    model.weights[type] = fit_tree_confidence(examples);
  }
  meter.finish();
  model.trained_on =
      fmt::format("{} rough and {} testbed forests of each type, {} treetops", rough, count - rough, tops);
  return model;
}

}  // namespace waymark::workflows
