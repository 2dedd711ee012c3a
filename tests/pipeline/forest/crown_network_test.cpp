// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/crown_network.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "workflows/detection/crown_detection.hpp"

namespace waymark::test {
using namespace pipeline;
using workflows::crown_width;
using workflows::kMaxCrownDiameter;
namespace {

constexpr double kCell = 0.6;

/// Dark crowns of `radius` metres on a lawn, grey roofs between; light falls evenly.
ColourWindow park(const std::vector<MarkedTree>& trees, double radius, std::int64_t side, bool infrared) {
  Random random(5, "park");
  ColourWindow image{{0, 0, side, side}, kCell, {}};
  image.bands.assign(infrared ? 4 : 3, Grid<float>(side, side));
  for (std::int64_t r = 0; r < side; ++r)
    for (std::int64_t c = 0; c < side; ++c) {
      double colour[] = {0.45, 0.55, 0.40, 0.70};
      if ((c / 24 + r / 24) % 3 == 0) colour[0] = colour[1] = colour[2] = 0.6, colour[3] = 0.5;
      for (const MarkedTree& tree : trees)
        if (std::hypot(tree.x - double(c), tree.y - double(r)) * kCell < radius)
          colour[0] = 0.18, colour[1] = 0.27, colour[2] = 0.2, colour[3] = 0.6;
      for (std::size_t band = 0; band < image.bands.size(); ++band)
        image.bands[band](c, r) = static_cast<float>(colour[band] + random.normal(0, 0.01));
    }
  return image;
}

ColourWindow cut(const ColourWindow& image, const Window& cells) {
  ColourWindow part{cells, image.cell, {}};
  for (const Grid<float>& band : image.bands) {
    part.bands.emplace_back(cells.columns, cells.rows, std::nanf(""));
    for (std::int64_t r = 0; r < cells.rows; ++r)
      for (std::int64_t c = 0; c < cells.columns; ++c)
        if (band.contains(cells.column + c, cells.row + r))
          part.bands.back()(c, r) = band(cells.column + c, cells.row + r);
  }
  return part;
}

TEST(CrownProbability, IsBitwiseTheSameInAnyWindow) {
  ColourWindow image = park({{60, 60}, {130, 100}}, 2.5, 220, true);
  for (Grid<float>& band : image.bands) band(100, 100) = band(101, 100) = std::nanf("");
  const Window whole = image.cells, part{70, 80, 50, 40};
  const Grid<float> all = crown_probability(image, whole, crown_network_infrared());
  const std::int64_t reach = crown_probability_reach(kCell);
  const Window around{part.column - reach, part.row - reach, part.columns + 2 * reach, part.rows + 2 * reach};
  const Grid<float> alone = crown_probability(cut(image, around), part, crown_network_infrared());
  for (std::int64_t r = 0; r < part.rows; ++r)
    for (std::int64_t c = 0; c < part.columns; ++c) {
      const float a = all(part.column + c, part.row + r), b = alone(c, r);
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << c << ' ' << r;
    }
  EXPECT_TRUE(std::isnan(all(100, 100)));
}

TEST(CrownProbability, IsHighestOnCrownsAndCaresLittleForExposure) {
  const std::vector<MarkedTree> trees{{50, 50}, {90, 130}, {150, 70}};
  for (const bool infrared : {true, false}) {
    const DenseNetwork& network = infrared ? crown_network_infrared() : crown_network_colour();
    for (const float exposure : {1.0F, 0.6F}) {
      ColourWindow image = park(trees, 2.4, 200, infrared);
      for (Grid<float>& band : image.bands)
        for (float& value : band.cells()) value *= exposure;
      const Grid<float> found = crown_probability(image, image.cells, network);
      const float lawn = found(20, 20);
      for (const MarkedTree& tree : trees)
        EXPECT_GT(found(std::llround(tree.x), std::llround(tree.y)), std::max(0.25F, 2 * lawn))
            << "infrared " << infrared << ", exposure " << exposure;
    }
  }
}

TEST(CrownWidth, IsThatOfALoneCrown) {
  for (const double radius : {1.8, 3.0, 4.8}) {
    const ColourWindow image = park({{60, 60}}, radius, 120, true);
    EXPECT_NEAR(crown_width(image, {60, 60}), 2 * radius, 2 * kCell);
  }
}

TEST(CrownWidth, EndsWhereTheImageDoes) {
  const ColourWindow image = park({{0, 0}}, 3, 40, false);
  EXPECT_NEAR(crown_width(image, {0, 0}), 6, 2 * kCell);
  const ColourWindow all_green = park({{10, 10}}, 100, 40, true);
  EXPECT_EQ(crown_width(all_green, {10, 10}), kMaxCrownDiameter);
}

TEST(CrownExamples, LearnTheMiddleOfCrowns) {
  NetworkExamples examples;
  for (std::uint64_t i = 0; i < 3; ++i) {
    std::vector<MarkedTree> trees;
    Random random(i, "places");
    for (int t = 0; t < 12; ++t) trees.push_back({random.uniform(10, 150), random.uniform(10, 150)});
    add_crown_examples(examples, park(trees, 2.4, 160, true), trees, 1, i);
  }
  ASSERT_EQ(examples.values.size(), examples.targets.size() * static_cast<std::size_t>(examples.inputs));
  const DenseNetwork network = train_network(examples, {.hidden = {8}, .rounds = 6});
  const ColourWindow image = park({{80, 80}}, 2.4, 160, true);
  const Grid<float> found = crown_probability(image, image.cells, network);
  EXPECT_GT(found(80, 80), 0.4F);
  EXPECT_LT(found(20, 130), 0.1F);
}

}  // namespace
}  // namespace waymark::test
