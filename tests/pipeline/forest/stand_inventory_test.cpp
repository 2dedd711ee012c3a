// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/stand_inventory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "tests/pipeline/forest/square_stand.hpp"

namespace waymark::test {
namespace {

using ::testing::ElementsAre;
pipeline::StandTree tree(double x, double y, double height, double dbh) {
  pipeline::StandTree t{.position = {x, y}, .height = height, .diameter = dbh};
  t.volume = pipeline::stem_volume(pipeline::built_in_volume()[0], dbh, height);
  return t;
}

// Half a hectare with trees of 20, 30 and 40 cm and 15, 25 and 30 m; a fourth stands outside.
std::vector<pipeline::StandTree> three_trees() {
  return {tree(10, 10, 15, 0.2), tree(20, 30, 25, 0.3), tree(50, 60, 30, 0.4), tree(200, 10, 40, 0.9)};
}
pipeline::StandPolygon half_hectare() {
  return {{{{0, 0}, {100, 0}, {100, 50}, {60, 50}, {60, 100}, {40, 100}, {40, 50}, {0, 50}}}};
}

TEST(StandInventory, IsWhatAHandComputes) {
  const pipeline::StandPolygon stand = half_hectare();
  ASSERT_DOUBLE_EQ(pipeline::area(stand), 6000);
  const pipeline::StandAttributes f = pipeline::inventory(three_trees(), stand, {});
  EXPECT_EQ(f.trees, 3);
  EXPECT_NEAR(f.hectares, 0.6, 1e-12);
  EXPECT_NEAR(f.stems.value, 5.0, 1e-12);  // 3 / 0.6
  // pi / 4 (0.04 + 0.09 + 0.16) / 0.6
  EXPECT_NEAR(f.basal_area.value, 0.2277655 / 0.6, 1e-6);
  EXPECT_NEAR(f.lorey_height.value, (0.04 * 15 + 0.09 * 25 + 0.16 * 30) / 0.29, 1e-12);  // 26.379
  EXPECT_NEAR(f.quadratic_mean_diameter.value, std::sqrt(0.29 / 3), 1e-12);              // 31.09 cm
  EXPECT_NEAR(f.mean_diameter.value, 0.3, 1e-12);
  EXPECT_NEAR(f.mean_height.value, 70.0 / 3, 1e-12);
  EXPECT_NEAR(f.volume.value, 0.47 * std::numbers::pi / 4 * (0.04 * 15 + 0.09 * 25 + 0.16 * 30) / 0.6, 1e-12);
  EXPECT_NEAR(f.dominant_height.value, 70.0 / 3, 1e-12);  // 60 wanted, three there
  EXPECT_TRUE(std::isnan(f.mass.value));
  std::vector<double> stems;
  for (const pipeline::DiameterClass& c : f.classes) stems.push_back(c.stems.value * 0.6);
  // [0,5) ... [40,45): lower edges belong to the class
  EXPECT_THAT(stems, ElementsAre(0, 0, 0, 0, ::testing::DoubleEq(1), 0, ::testing::DoubleEq(1), 0,
                                 ::testing::DoubleEq(1)));
  for (const pipeline::Estimate* e :
       {&f.stems, &f.basal_area, &f.lorey_height, &f.volume, &f.dominant_height})
    EXPECT_EQ(e->se, 0) << "nothing errs";
}

TEST(StandInventory, DominantHeightTakesAFractionOfTheLastTree) {
  // 0.016 ha: the 1.6 thickest. 30 m whole, 20 m for 0.6.
  pipeline::StandPolygon stand{{{{0, 0}, {16, 0}, {16, 10}, {0, 10}}}};
  const std::vector<pipeline::StandTree> trees{tree(1, 1, 20, 0.3), tree(2, 2, 30, 0.4), tree(3, 3, 35, 0.1)};
  EXPECT_NEAR(pipeline::inventory(trees, stand).dominant_height.value, (30 + 0.6 * 20) / 1.6, 1e-12);
}

TEST(StandInventory, ErrorsOfTreesBecomeErrorsOfFigures) {
  std::vector<pipeline::StandTree> trees = three_trees();
  for (pipeline::StandTree& t : trees) t.diameter_sd = 0.03, t.height_sd = 1;
  const pipeline::StandAttributes f = pipeline::inventory(trees, half_hectare(), {.form_factor_error = 0.1});
  // d(sum g) = pi / 2 d dd
  EXPECT_NEAR(f.basal_area.se, std::numbers::pi / 2 * 0.03 * std::sqrt(0.29) / 0.6, 1e-9);
  EXPECT_NEAR(f.mean_height.se, 1 / std::sqrt(3), 1e-12);
  EXPECT_NEAR(f.mean_diameter.se, 0.03 / std::sqrt(3), 1e-12);
  EXPECT_NEAR(f.dominant_height.se, 1 / std::sqrt(3), 1e-12);
  EXPECT_GT(f.volume.se, 0.1 * f.volume.value) << "the form factor errs for all trees alike";
  for (pipeline::StandTree& t : trees) t.diameter_sd = 0, t.diameter_bias = 0.03;
  EXPECT_NEAR(pipeline::inventory(trees, half_hectare()).mean_diameter.se, 0.03, 1e-12)
      << "a shared error does not average";
}

TEST(StandInventory, DoubtfulTreesAndEdgesWidenTheErrors) {
  std::vector<pipeline::StandTree> trees = three_trees();
  for (pipeline::StandTree& t : trees) t.confidence = 0.8;
  const pipeline::StandAttributes f = pipeline::inventory(trees, half_hectare());
  EXPECT_NEAR(f.stems.value, 5, 1e-12) << "what is counted is what was found";
  EXPECT_NEAR(f.stems.se, std::sqrt(3 * 0.16) / 0.6, 1e-12);
  // A tree on the edge itself is inside with probability one half, wherever it is counted.
  std::vector<pipeline::StandTree> edge{tree(0, 25, 20, 0.3)};
  edge[0].position_sd = 0.5;
  EXPECT_NEAR(pipeline::inventory(edge, half_hectare()).stems.se, 0.5 / 0.6, 1e-9);
  edge[0].position.x() = -0.5;  // one deviation outside: 0.1587 inside
  const pipeline::StandAttributes out = pipeline::inventory(edge, half_hectare());
  EXPECT_EQ(out.trees, 0);
  EXPECT_NEAR(out.stems.se, std::sqrt(0.158655 * 0.841345) / 0.6, 1e-6);
}

TEST(StandInventory, RecallCountsTheTreesNobodyFound) {
  const std::vector<pipeline::RecallRow> recall{{0, 0.5, 0.1}, {20, 0.8, 0}};
  const pipeline::StandAttributes f = pipeline::inventory(three_trees(), half_hectare(), {.recall = recall});
  EXPECT_NEAR(f.stems.value, (1 / 0.5 + 2 / 0.8) / 0.6, 1e-12);
  EXPECT_NEAR(f.mean_height.value, (15 * 2 + 25 * 1.25 + 30 * 1.25) / 4.5, 1e-12);
  const double binomial = 0.5 / 0.25 + 2 * 0.2 / 0.64, shared = std::pow(2 * 0.1 / 0.5, 2);
  EXPECT_NEAR(f.stems.se, std::sqrt(binomial + shared) / 0.6, 1e-12);
}

TEST(StandInventory, AnEmptyStandHasNoTreesAndNoHeights) {
  const pipeline::StandAttributes f = pipeline::inventory({}, half_hectare());
  EXPECT_EQ(f.stems.value, 0);
  EXPECT_EQ(f.basal_area.value, 0);
  EXPECT_TRUE(std::isnan(f.lorey_height.value));
  EXPECT_TRUE(std::isnan(f.dominant_height.value));
  const pipeline::StandAttributes nothing = pipeline::inventory(three_trees(), {});
  EXPECT_TRUE(std::isnan(nothing.stems.value)) << "no area, no density";
}

TEST(StandInventory, TreesWithoutDiameterCountAsStemsOnly) {
  std::vector<pipeline::StandTree> trees = three_trees();
  trees[2].diameter = trees[2].volume = pipeline::StandTree::kUnknown;
  const pipeline::StandAttributes f = pipeline::inventory(trees, half_hectare());
  EXPECT_EQ(f.without_diameter, 1);
  EXPECT_NEAR(f.stems.value, 5, 1e-12);
  EXPECT_NEAR(f.basal_area.value, std::numbers::pi / 4 * 0.13 / 0.6, 1e-12);
  EXPECT_NEAR(f.lorey_height.value, (0.04 * 15 + 0.09 * 25) / 0.13, 1e-12);
  for (pipeline::StandTree& t : trees) t.diameter = t.volume = pipeline::StandTree::kUnknown;
  EXPECT_TRUE(std::isnan(pipeline::inventory(trees, half_hectare()).basal_area.value)) << "unknown, not none";
}

TEST(StandPolygon, HolesTakeAwayAndIslandsInThemAdd) {
  pipeline::StandPolygon stand = square_stand(0, 0, 100);
  stand.rings.push_back(square_stand(20, 20, 40).rings[0]);
  stand.rings.push_back(square_stand(30, 30, 10).rings[0]);
  std::ranges::reverse(stand.rings[1]);  // the orientation does not matter
  EXPECT_DOUBLE_EQ(pipeline::area(stand), 10000 - 1600 + 100);
  EXPECT_TRUE(pipeline::inside(stand, {10, 10}));
  EXPECT_FALSE(pipeline::inside(stand, {25, 25}));
  EXPECT_TRUE(pipeline::inside(stand, {35, 35}));
  EXPECT_DOUBLE_EQ(pipeline::distance_to_edge(stand, {25, 40}), 5);
}

TEST(StandPolygon, NeighboursShareNoTreeAndLoseNone) {
  Random random(3);
  // Triangles that fan out from a corner, over trees on a lattice that lie on their edges too.
  std::vector<Eigen::Vector2d> rim;
  for (int i = 0; i <= 12; ++i)
    rim.emplace_back(60 * std::cos(i * std::numbers::pi / 24), 60 * std::sin(i * std::numbers::pi / 24));
  std::vector<pipeline::StandPolygon> stands;
  for (std::size_t i = 0; i + 1 < rim.size(); ++i) stands.push_back({{{{0, 0}, rim[i], rim[i + 1]}}});
  pipeline::StandPolygon whole{{{{0, 0}}}};
  whole.rings[0].insert(whole.rings[0].end(), rim.begin(), rim.end());
  for (int k = 0; k < 3000; ++k) {
    const Eigen::Vector2d at(std::floor(random.uniform(0, 60)), std::floor(random.uniform(0, 60)));
    const auto in =
        std::ranges::count_if(stands, [&](const auto& stand) { return pipeline::inside(stand, at); });
    EXPECT_EQ(in, pipeline::inside(whole, at) ? 1 : 0) << at.transpose();
  }
}

TEST(StandPolygon, CellsCutOffAtTheEdgeMakeUpTheWhole) {
  pipeline::StandPolygon stand{{{{3, 2}, {97, 11}, {60, 50}, {88, 93}, {9, 71}}}};
  stand.rings.push_back(square_stand(30, 30, 17).rings[0]);
  double sum = 0;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 7; ++j)
      sum += pipeline::area(pipeline::clip_polygon(
          stand, {Eigen::Vector2d(15.0 * i, 15.0 * j), Eigen::Vector2d(15.0 * i + 15, 15.0 * j + 15)}));
  EXPECT_NEAR(sum, pipeline::area(stand), 1e-9);
  EXPECT_TRUE(
      pipeline::clip_polygon(stand, {Eigen::Vector2d(200, 200), Eigen::Vector2d(300, 300)}).rings.empty());
}

TEST(StandPolygon, TheGroundOfUniformTreesIsAboutTheirs) {
  double sum = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    std::vector<Eigen::Vector2d> trees;
    for (int i = 0; i < 200; ++i) trees.emplace_back(random.uniform(0, 100), random.uniform(0, 100));
    sum += pipeline::area(pipeline::estimate_sampled_area(trees)) / 40;
  }
  EXPECT_NEAR(sum, 10000, 250) << "Ripley and Rasson's estimate is nearly unbiased";
  EXPECT_TRUE(pipeline::estimate_sampled_area({{0, 0}, {1, 1}, {2, 2}, {3, 3}}).rings.empty());
  EXPECT_TRUE(pipeline::estimate_sampled_area({{0, 0}, {1, 0}, {0, 1}}).rings.empty());
}

// Slow twin: every tree against every stand, sums written out.
pipeline::StandAttributes by_definition(const std::vector<pipeline::StandTree>& trees,
                                        const pipeline::StandPolygon& stand) {
  pipeline::StandAttributes f;
  f.hectares = pipeline::area(stand) / 1e4;
  double n = 0, g = 0, gh = 0, v = 0;
  std::vector<std::pair<double, double>> thick;
  for (const pipeline::StandTree& t : trees) {
    if (!pipeline::inside(stand, t.position)) continue;
    ++f.trees, n += 1;
    g += std::numbers::pi / 4 * t.diameter * t.diameter;
    gh += std::numbers::pi / 4 * t.diameter * t.diameter * t.height;
    v += t.volume;
    thick.emplace_back(-t.diameter, t.height);
  }
  std::ranges::sort(thick);
  double left = 100 * f.hectares, weight = 0, heights = 0;
  for (const auto& [d, h] : thick) {
    const double share = std::clamp(left, 0.0, 1.0);
    left -= share, weight += share, heights += share * h;
  }
  f.stems.value = n / f.hectares;
  f.basal_area.value = g / f.hectares;
  f.volume.value = v / f.hectares;
  f.lorey_height.value = gh / g;
  f.dominant_height.value = heights / weight;
  return f;
}

TEST(StandInventory, MatchesItsTwinAndItsErrorsAreThoseOfRepetition) {
  Random random(11);
  std::vector<pipeline::StandTree> trees;
  for (int i = 0; i < 400; ++i) {
    trees.push_back(tree(random.uniform(-20, 120), random.uniform(-20, 120), random.uniform(8, 35),
                         random.uniform(0.1, 0.5)));
    trees.back().height_sd = 0.8, trees.back().diameter_sd = 0.04, trees.back().position_sd = 0.7;
    trees.back().confidence = 0.9;
  }
  pipeline::StandPolygon stand = square_stand(0, 0, 100);
  stand.rings.push_back(square_stand(30, 30, 20).rings[0]);
  const pipeline::StandAttributes reported = pipeline::inventory(trees, stand),
                                  twin = by_definition(trees, stand);
  EXPECT_EQ(reported.trees, twin.trees);
  EXPECT_NEAR(reported.stems.value, twin.stems.value, 1e-9);
  EXPECT_NEAR(reported.basal_area.value, twin.basal_area.value, 1e-9);
  EXPECT_NEAR(reported.volume.value, twin.volume.value, 1e-9);
  EXPECT_NEAR(reported.lorey_height.value, twin.lorey_height.value, 1e-9);
  EXPECT_NEAR(reported.dominant_height.value, twin.dominant_height.value, 1e-9);

  // Monte Carlo: the spread over trees drawn within their errors equals the standard errors.
  const int kDraws = 600;
  double sum[4] = {}, squares[4] = {};
  for (int k = 0; k < kDraws; ++k) {
    std::vector<pipeline::StandTree> drawn;
    for (pipeline::StandTree t : trees) {
      if (!random.bernoulli(t.confidence)) continue;
      t.position += Eigen::Vector2d(random.normal(0, t.position_sd), random.normal(0, t.position_sd));
      const double height = random.normal(t.height, t.height_sd),
                   diameter = random.normal(t.diameter, t.diameter_sd);
      t.volume *= height / t.height * std::pow(diameter / t.diameter, 2);
      t.height = height, t.diameter = diameter;
      drawn.push_back(t);
    }
    const pipeline::StandAttributes f = by_definition(drawn, stand);
    const double values[] = {f.stems.value, f.basal_area.value, f.volume.value, f.lorey_height.value};
    for (int i = 0; i < 4; ++i) sum[i] += values[i] / kDraws, squares[i] += values[i] * values[i] / kDraws;
  }
  const pipeline::Estimate estimates[] = {reported.stems, reported.basal_area, reported.volume,
                                          reported.lorey_height};
  for (int i = 0; i < 4; ++i) {
    const double spread = std::sqrt(squares[i] - sum[i] * sum[i]);
    EXPECT_NEAR(estimates[i].se / spread, 1, 0.12) << i;  // 600 draws estimate a spread to 3 %
  }
}

}  // namespace
}  // namespace waymark::test
