// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/find_craters.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "pipeline/craters/bowl_template.hpp"
#include "pipeline/craters/bowl_verification.hpp"
#include "pipeline/craters/crater_model.hpp"
#include "pipeline/craters/shaded_scene.hpp"
#include "pipeline/craters/shape_search.hpp"
#include "tests/pipeline/craters/score_circles.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using ::testing::HasSubstr;
constexpr double kPi = std::numbers::pi;

// A paraboloid with a rim lit from `sun`, on a noisy plain.
Pixels one_bowl(int side, double x, double y, double diameter, double sun, double noise = 2) {
  Random random(7, "one bowl");
  Pixels image(side, side);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double u = (column - x) / (diameter / 2), v = (row - y) / (diameter / 2), r = std::hypot(u, v);
      const double along = u * std::cos(sun) + v * std::sin(sun);
      const double slope = r < 1 ? -along : 0.3 * along / std::pow(r, 5);
      image(column, row) = static_cast<float>(128 + 60 * slope + random.normal(0, noise));
    }
  return image;
}

TEST(FindCraters, OneBowlWhereverTheSunStands) {
  for (const double sun : {0.0, 1.1, 2.5, -2.0}) {
    const auto found = find_craters(one_bowl(160, 70.3, 88.7, 30, sun), {.sun_angle = Radians{sun}});
    ASSERT_FALSE(found.empty()) << sun;
    EXPECT_NEAR(found[0].outline.x, 70.3, 0.6);
    EXPECT_NEAR(found[0].outline.y, 88.7, 0.6);
    EXPECT_NEAR(found[0].outline.diameter(), 30, 1.5);
    EXPECT_GT(found[0].confidence, 0.8);
  }
}

TEST(FindCraters, ADomeIsNoCrater) {
  const auto found = find_craters(one_bowl(160, 80, 80, 30, 0.5), {.sun_angle = Radians{0.5 + kPi}});
  for (const Detection& d : found)
    EXPECT_GT(std::hypot(d.outline.x - 80, d.outline.y - 80), 5) << "a bowl lit from behind is a dome";
}

TEST(FindCraters, BrightnessScaleAndOffsetDoNotMatter) {
  Pixels image = one_bowl(128, 60, 64, 24, 0.3);
  const auto before = find_craters(image, {.sun_angle = Radians{0.3}});
  for (float& v : image.cells()) v = v * 16 + 4096;  // exact in float: powers of two
  const auto after = find_craters(image, {.sun_angle = Radians{0.3}});
  ASSERT_EQ(before.size(), after.size());
  EXPECT_NEAR(before[0].outline.x, after[0].outline.x, 0.05);
  EXPECT_NEAR(before[0].confidence, after[0].confidence, 0.02);
}

TEST(FindCraters, NothingToSeeIsNoError) {
  EXPECT_TRUE(find_craters(Pixels(), {}).empty());
  EXPECT_TRUE(find_craters(Pixels(1, 1, 5.0F), {}).empty());
  EXPECT_TRUE(find_craters(Pixels(200, 200, 0.0F), {}).empty());
  EXPECT_TRUE(find_craters(Pixels(64, 64, std::numeric_limits<float>::quiet_NaN()), {}).empty());
}

TEST(FindCraters, HolesHideOnlyWhatLiesInThem) {
  Pixels image = one_bowl(160, 110, 80, 28, 0);
  for (std::int64_t y = 0; y < 160; ++y)
    for (std::int64_t x = 0; x < 70; ++x) image(x, y) = std::numeric_limits<float>::quiet_NaN();
  const auto found = find_craters(image, {.sun_angle = Radians{0}});
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found[0].outline.x, 110, 1);
  for (const Detection& d : found) EXPECT_GT(d.outline.x, 60);
}

TEST(FindCraters, RefusesWhatMakesNoSense) {
  const Pixels image(32, 32, 1.0F);
  try {
    find_craters(image, {.min_diameter = 20, .max_diameter = 10});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_THAT(error.what(), HasSubstr("max_diameter is 10 px, less than min_diameter, 20 px"));
  }
  EXPECT_THROW(find_craters(image, {.sun_angle = Radians{std::nan("")}}), Error);
  EXPECT_THROW(find_craters(image, {.min_diameter = 3}), Error);
}

TEST(CraterSunAngle, FindsTheLightOfMadeUpScenes) {
  int right = 0, answered = 0;
  for (std::uint64_t seed = 9000; seed < 9006; ++seed) {
    const LabelledScene scene = shaded_scene(seed, 384);
    const auto seen = estimate_crater_sun_angle(scene.image);
    if (!seen || seen->craters < 12) continue;
    ++answered;
    right += std::abs(std::remainder(seen->angle.value - scene.sun_angle.value, 2 * kPi)) < 0.2 ? 1 : 0;
  }
  EXPECT_GE(answered, 2);
  EXPECT_EQ(right, answered);
}

// The slow twin of the overlap-save search: correlation by the definition.
double correlation_by_definition(const Pixels& image, const Pixels& shape, int column, int row) {
  const int half = static_cast<int>(shape.columns() / 2);
  double n = 0, a = 0, aa = 0, product = 0;
  for (int j = -half; j <= half; ++j)
    for (int i = -half; i <= half; ++i) {
      const double v = image(column + i, row + j);
      ++n, a += v, aa += v * v, product += v * shape(i + half, j + half);
    }
  return product / std::sqrt(aa - a * a / n);
}

TEST(ShapeSearch, AgreesWithTheDefinition) {
  const double sun = 0.7;
  const Pixels image = one_bowl(300, 141, 150, 16, sun, 0.5);
  const auto shapes = [&](double diameter) {
    return std::vector{bowl_template(diameter, Radians{sun}, BowlLight::slope)};
  };
  const auto found = shape_candidates(
      image, {.limits = {.min_diameter = 12, .max_diameter = 23, .min_correlation = 0.6}, .shapes = shapes});
  ASSERT_FALSE(found.empty());
  CraterCandidate best;
  for (const CraterCandidate& c : found)
    if (c.score > best.score) best = c;
  EXPECT_NEAR(best.x, 141, 0.5);
  EXPECT_NEAR(best.y, 150, 0.5);
  const double slow = correlation_by_definition(image, shapes(best.diameter)[0], 141, 150);
  EXPECT_NEAR(best.score, slow, 0.01);  // lowered a little by the noise term
}

TEST(RefineRim, BiasBelowOnePercentOnCleanBowls) {
  double bias = 0, centre = 0;
  int count = 0;
  for (const double diameter : {16.0, 24.0, 40.0, 64.0})
    for (const double off : {-0.08, 0.0, 0.08}) {
      const Pixels image = one_bowl(140, 70.25, 69.5, diameter, 1.0, 1);
      const auto rim =
          refine_rim(image, {70.25 + off * diameter, 69.5, diameter * (1 + off), 1}, Radians{1.0});
      ASSERT_TRUE(rim);
      bias += rim->ellipse.diameter() / diameter - 1;
      centre += std::hypot(rim->ellipse.x - 70.25, rim->ellipse.y - 69.5) / diameter;
      ++count;
    }
  EXPECT_LE(std::abs(bias / count), 0.02);
  EXPECT_LE(centre / count, 0.03);
}

TEST(SuppressOverlaps, KeepsWhatTheDefinitionKeeps) {
  Random random(3, "circles");
  std::vector<CraterCandidate> all;
  for (int i = 0; i < 600; ++i)
    all.push_back(
        {random.uniform(0, 200), random.uniform(0, 200), random.log_uniform(6, 120), random.uniform()});
  for (const double most : {0.1, 0.25, 0.5}) {
    auto sorted = all;
    sort_by_score(sorted);
    std::vector<CraterCandidate> slow;
    for (const CraterCandidate& c : sorted)
      if (std::none_of(slow.begin(), slow.end(),
                       [&](const CraterCandidate& k) { return same_rim(k, c, most); }))
        slow.push_back(c);
    EXPECT_EQ(suppress_overlaps(all, most), slow);
  }
}

TEST(CraterModel, TextKeepsIt) {
  const CraterModel& model = built_in_crater_model();
  const CraterModel again = parse_crater_model(as_text(model), "test");
  CraterFeatures features{};
  for (std::size_t i = 0; i < features.size(); ++i) features[i] = static_cast<float>(std::sin(double(i)));
  EXPECT_NEAR(predict(model, features).probability, predict(again, features).probability, 1e-3);
}

TEST(CraterModel, ShippedTextIsWhatTrainingWrites) {
  const std::string text = as_text(built_in_crater_model());
  EXPECT_EQ(as_text(parse_crater_model(text, "test")), text);
  EXPECT_THAT(text, HasSubstr("scenes 0 to 119, 640 px"));
}

// The slow twin: each output by itself, its products in the order of the inputs.
TEST(CraterModel, SumsInOrderOfInputs) {
  const CraterModel& model = built_in_crater_model();
  CraterFeatures features{};
  for (std::size_t i = 0; i < features.size(); ++i)
    features[i] = static_cast<float>(std::cos(3.0 * double(i)));
  std::vector<float> in(features.begin(), features.end());
  for (const CraterModel::Layer& layer : model.layers) {
    std::vector<float> out;
    for (std::size_t o = 0; o < layer.biases.size(); ++o) {
      float total = 0;
      for (std::size_t i = 0; i < in.size(); ++i) total += layer.weights[o * in.size() + i] * in[i];
      total += layer.biases[o];
      out.push_back(&layer == &model.layers.back() || total > 0 ? total : 0.1F * total);
    }
    in = out;
  }
  EXPECT_EQ(predict(model, features).probability, 1 / (1 + std::exp(-double(in[0]))));
}

TEST(CraterModel, SaysWhatIsWrongWithAFile) {
  const auto message = [](const std::string& text) {
    try {
      parse_crater_model(text, "m.txt");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(message("hello"), HasSubstr("it does not begin with 'waymark network 2 craters'"));
  EXPECT_THAT(message("waymark crater model 1\nx\nlayer 2 4\n"), HasSubstr("m.txt, line 3"));
  EXPECT_THAT(message("waymark crater model 1\nx\n"), HasSubstr("the last layer must have 4 outputs"));
}

// A dish in heights.
HeightWindow dish(int columns, int rows, double x, double y, double diameter, double depth) {
  HeightWindow heights(columns, rows);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double r = std::hypot(column - x, row - y) / (diameter / 2);
      heights(column, row) = 100 + 0.05 * column + depth * (r < 1 ? 1.2 * r * r - 1 : 0.2 / (r * r * r));
    }
  return heights;
}

TEST(FindCratersInDem, MeasuresADish) {
  const auto found = find_craters(dish(200, 180, 90.5, 80, 40, 4), DemCraterSearch{});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].column, 90.5, 1);
  EXPECT_NEAR(found[0].row, 80, 1);
  EXPECT_NEAR(found[0].diameter(), 40, 2);
  EXPECT_NEAR(found[0].depth, 4.6,
              0.6);  // crest 0.2 above, floor 1 below the plain, the deepest fifth of the floor
}

TEST(FindCratersInDem, AHillIsNoCraterAndAShallowDishNeither) {
  EXPECT_TRUE(find_craters(dish(200, 180, 90, 80, 40, -4), DemCraterSearch{}).empty());
  EXPECT_TRUE(find_craters(dish(200, 180, 90, 80, 40, 0.3), DemCraterSearch{}).empty());
}

TEST(FindCratersInDem, RefusesCellsWithoutSize) {
  EXPECT_THROW(find_craters(HeightWindow(32, 32, 0.0), DemCraterSearch{.cell_width = 0}), Error);
  EXPECT_TRUE(find_craters(HeightWindow(64, 64, kNoHeight), DemCraterSearch{}).empty());
}

TEST(FindCraters, MadeUpScenesNotTrainedOn) {
  int hits = 0, false_alarms = 0, misses = 0;
  for (std::uint64_t seed = 5000; seed < 5004; ++seed) {
    const LabelledScene scene = shaded_scene(seed, 512);
    std::vector<CraterCandidate> truth, found;
    for (const LabelledCrater& c : scene.craters)
      if (c.clarity >= 0.5) truth.push_back({c.x, c.y, c.diameter, 1});
    for (const Detection& d : find_craters(scene.image, {.sun_angle = scene.sun_angle}))
      found.push_back({d.outline.x, d.outline.y, d.outline.diameter(), d.confidence});
    const CircleScore score = score_circles(found, truth, 16);
    std::cout << "scene " << seed << ": " << score.text() << '\n';
    hits += score.hits, false_alarms += score.false_alarms, misses += score.misses;
  }
  EXPECT_GE(2.0 * hits / std::max(1, 2 * hits + false_alarms + misses), 0.5);
}

}  // namespace
}  // namespace waymark::test
