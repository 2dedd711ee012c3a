// SPDX-License-Identifier: Apache-2.0
// How good the detector is, on views that nothing was fitted to. The figures are those of
// docs/evaluation/2026-11-21-rock-detection.md.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <utility>
#include <vector>

#include "pipeline/rocks/find_rocks.hpp"
#include "pipeline/rocks/rock_training.hpp"
#include "tests/pipeline/rocks/rock_score.hpp"
#include "tests/support/seed_offset.hpp"
#include "workflows/training/rock_views.hpp"
namespace waymark::test {
using namespace pipeline;
using namespace workflows;
namespace {

void print(const char* title, const RockScore& score) {
  std::printf("%s\n%s", title, score.text().c_str());
}

RockScore score_of(RockScene scene, int scenes, RockMethod method = RockMethod::shadow) {
  RockScore score;
  for (int k = 0; k < scenes; ++k) {
    scene.seed = static_cast<std::uint64_t>(900 + k) + seed_offset();
    scene.sun_angle = {40.0 + 77 * k};
    const RockImage image = render(scene);
    const double sun = to_radians(scene.sun_angle).value;
    score.add(image,
              find_rocks(image.pixels, {.method = method,
                                        .sun_angle = Radians{sun},
                                        .sun_elevation = to_radians(Degrees{90 - scene.incidence.value})}),
              sun);
  }
  return score;
}

class AtIncidence : public ::testing::TestWithParam<double> {};

TEST_P(AtIncidence, EllipsoidsOnLevelGround) {
  const RockScore score = score_of({.columns = 256, .rows = 256, .incidence = {GetParam()}}, 2);
  print("ellipsoids", score);
  EXPECT_GE(score.recall(1), 0.95);
  EXPECT_GE(score.recall(2), 0.98);
  EXPECT_GE(score.precision(), 0.95);
  EXPECT_LE(std::abs(score.width(1).bias), 0.10);
  EXPECT_LE(std::abs(score.width(2).bias), 0.10);
  EXPECT_LE(score.median_offset(2), 0.7);  // the table stands between ellipsoids and cylinders
}

TEST_P(AtIncidence, MixedShapesAmongDunesAndCraters) {
  const RockScore score = score_of({.columns = 256,
                                    .rows = 256,
                                    .incidence = {GetParam()},
                                    .shape = RockScene::Shape::mixed,
                                    .dunes = 1.2,
                                    .craters = 0.15},
                                   2);
  print("mixed, dunes, craters", score);
  EXPECT_GE(score.recall(1), 0.7);
  EXPECT_GE(score.recall(2), 0.75);
  EXPECT_GE(score.precision(), 0.9);
}

INSTANTIATE_TEST_SUITE_P(Sun, AtIncidence, ::testing::Values(30.0, 45.0, 60.0, 72.0));

// Of the testbed's views, never used for fitting: craters, dunes, slopes, all rocks down to 1 px.
TEST(RockTargets, MadeViews) {
  const char* more = std::getenv("WAYMARK_ROCK_VIEWS");
  const int views = more != nullptr ? std::atoi(more) : 6;
  RockScore score, guessed, classic;
  for (int k = 1000; k < 1000 + views; ++k) {
    const SyntheticView view = synthetic_view(k + static_cast<int>(seed_offset()));
    RockSearch search{.sun_angle = Radians{view.sun_angle}, .sun_elevation = view.elevation};
    score.add(view.image, find_rocks(view.image.pixels, search), view.sun_angle);
    guessed.add(view.image, find_rocks(view.image.pixels, {}), view.sun_angle);
    search.method = RockMethod::classic;
    classic.add(view.image, find_rocks(view.image.pixels, search), view.sun_angle);
  }
  print("testbed", score);
  print("testbed, sun unknown", guessed);
  print("testbed, classic", classic);
  // Short of the targets (0.95, 0.90): most rocks of these six stand in view 1002, under a sun of 20 degrees
  // whose shadows of the ground hide many. With the sun unknown that view fails, so nothing is promised there
  // yet.
  EXPECT_GE(score.recall(1), 0.4);
  EXPECT_GE(score.precision(), 0.9);
  EXPECT_GT(score.recall(0), classic.recall(0));
}

// The tables of docs/evaluation/2026-11-21-rock-shapes-and-slopes.md; dunes and craters are in all scenes.
TEST(RockTargets, ByShapeAndSlope) {
  std::printf(
      "| shape, slope, incidence | recall 2-3 / 3-5 / 5-8 / > 8 px | precision | width bias, SD | "
      "reach bias, SD | place, median | ellipse |\n|---|---|---|---|---|---|---|\n");
  const std::pair<RockScene::Shape, const char*> shapes[] = {{RockScene::Shape::ellipsoid, "ellipsoid"},
                                                             {RockScene::Shape::irregular, "irregular"},
                                                             {RockScene::Shape::cylinder, "cylinder"}};
  int number = 0;
  for (const auto& [shape, name] : shapes)
    for (const double slope : {0.0, 10.0})
      for (const double incidence : {30.0, 45.0, 60.0, 72.0}) {
        ++number;
        const RockScene scene{.columns = 256,
                              .rows = 256,
                              .incidence = {incidence},
                              .sun_angle = {77.0 * number},
                              .shape = shape,
                              .cover = 0.04,
                              .slope = {slope},
                              .downhill = {50.0 * number},
                              .dunes = 1.2,
                              .craters = 0.15,
                              .seed = static_cast<std::uint64_t>(700 + number) + seed_offset()};
        const RockImage image = render(scene);
        const double sun = to_radians(scene.sun_angle).value;
        RockScore score;
        score.add(image,
                  find_rocks(image.pixels, {.sun_angle = Radians{sun},
                                            .sun_elevation = to_radians(Degrees{90 - incidence})}),
                  sun);
        std::printf(
            "| %s, %g, %g | %.2f / %.2f / %.2f / %.2f | %.2f | %+.0f %%, %.0f %% | %+.0f %%, %.0f %% | "
            "%.2f px | %.2f |\n",
            name, slope, incidence, score.recall(0), score.recall(1), score.recall(2), score.recall(3),
            score.precision(), 100 * score.width(1).bias, 100 * score.width(1).sd, 100 * score.reach(1).bias,
            100 * score.reach(1).sd, score.median_offset(1), score.ellipse_cover());
        EXPECT_GE(score.precision(), 0.75) << name << " " << slope << " " << incidence;
        EXPECT_GE(score.recall(1), 0.6) << name << " " << slope << " " << incidence;
      }
}

// The averaged network returns the mean of both outputs.
TEST(RockNetwork, JoinedSaysTheMean) {
  const auto net = [](float mean, float sd, float weight, float bias, float out) {
    RockNetwork one{.rock_prior = 0.5F,
                    .mean = std::vector<float>(kEvidenceCount, mean),
                    .sd = std::vector<float>(kEvidenceCount, sd),
                    .hidden = std::vector<float>(kEvidenceCount, weight),
                    .out = std::vector<float>(16, out),
                    .trained_on = "nothing"};
    one.hidden.push_back(bias);
    return one;
  };
  const auto says = [](const RockNetwork& n, float in) {
    const std::size_t units = n.hidden.size() / (kEvidenceCount + 1);
    double sum = static_cast<double>(n.out[8 * units]);
    for (std::size_t h = 0; h < units; ++h) {
      double unit = static_cast<double>(n.hidden[units * kEvidenceCount + h]);
      for (std::size_t i = 0; i < kEvidenceCount; ++i)
        unit += static_cast<double>(n.hidden[units * i + h] * (in - n.mean[i]) / n.sd[i]);
      sum += static_cast<double>(n.out[8 * h]) * std::tanh(unit);
    }
    return sum;
  };
  const RockNetwork a = net(0.2F, 2, 0.003F, 0.1F, 0.7F), b = net(-0.1F, 0.5F, 0.001F, -0.2F, 1.1F);
  for (const float in : {-1.0F, 0.0F, 0.4F})
    EXPECT_NEAR(says(average_networks(a, b), in), (says(a, in) + says(b, in)) / 2, 1e-5);
}

}  // namespace
}  // namespace waymark::test
