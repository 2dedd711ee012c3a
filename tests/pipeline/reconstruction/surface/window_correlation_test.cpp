// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/window_correlation.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/random.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr int kSide = 2 * kWindowMargin + 1;

Resampled random_view(Random& random, Eigen::Index columns, Eigen::Index rows) {
  Resampled view(columns, rows);
  for (float& value : view.reshaped()) value = static_cast<float>(100 + 20 * random.normal());
  return view;
}

// The definition, window by window in double precision.
double correlation_by_definition(const Resampled& a, const Resampled& b, Eigen::Index x, Eigen::Index y) {
  const Eigen::ArrayXXd p = a.block(x, y, kSide, kSide).cast<double>(),
                        q = b.block(x, y, kSide, kSide).cast<double>();
  const Eigen::ArrayXXd dp = p - p.mean(), dq = q - q.mean();
  return (dp * dq).sum() / std::sqrt(dp.square().sum() * dq.square().sum());
}

TEST(WindowCorrelation, MatchesTheDefinition) {
  Random random(1);
  const std::vector<Resampled> views{random_view(random, 20, 17), random_view(random, 20, 17)};
  const std::vector<double> no_limit{0, 0};
  const std::vector<ViewPair> pairs{{0, 1, 0.3}};
  const WindowScores scores = correlate_windows(views, no_limit, pairs);
  ASSERT_EQ(scores.pairs[0].rows(), 14);
  ASSERT_EQ(scores.pairs[0].cols(), 11);
  for (Eigen::Index y = 0; y < 11; ++y)
    for (Eigen::Index x = 0; x < 14; ++x)
      EXPECT_NEAR(static_cast<double>(scores.pairs[0](x, y)),
                  correlation_by_definition(views[0], views[1], x, y), 1e-4);
}

TEST(WindowCorrelation, IgnoresBrightnessAndContrast) {
  Random random(2);
  const Resampled view = random_view(random, 12, 12);
  const std::vector<Resampled> views{view, 0.5f * view + 30.0f};
  const std::vector<double> no_limit{0, 0};
  const std::vector<ViewPair> pairs{{0, 1, 0.3}};
  EXPECT_TRUE(((correlate_windows(views, no_limit, pairs).pairs[0] - 1).abs() < 1e-3f).all());
}

TEST(WindowCorrelation, WindowsWithoutTextureOrDataHaveNoScore) {
  Random random(3);
  std::vector<Resampled> views{random_view(random, 16, 8), random_view(random, 16, 8),
                               random_view(random, 16, 8)};
  views[1].leftCols(8) = 50;                                 // no texture
  views[2](0, 0) = std::numeric_limits<float>::quiet_NaN();  // spoils the windows that contain it
  const std::vector<double> min_sd{1, 1, 1};
  const std::vector<ViewPair> pairs{{0, 1, 0.3}, {0, 2, 0.3}};
  const WindowScores scores = correlate_windows(views, min_sd, pairs);
  EXPECT_TRUE(scores.pairs[0].isNaN().all());
  EXPECT_TRUE(std::isnan(scores.pairs[1](0, 0)));
  EXPECT_FALSE(std::isnan(scores.pairs[1](1, 0)));
  EXPECT_EQ(scores.textured(0, 0), 1);
  EXPECT_EQ(scores.complete(0, 0), 2);
  EXPECT_EQ(scores.textured(1, 0), 2);
}

TEST(MeanOfLargest, TakesTheBestFractionOfTheKnown) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> values{0.2f, kNone, 0.8f, 0.6f, 0.4f};
  EXPECT_FLOAT_EQ(mean_of_largest(values, 0.5), 0.7f);
  std::vector<float> none{kNone, kNone};
  EXPECT_TRUE(std::isnan(mean_of_largest(none, 0.5)));
  std::vector<float> one{0.3f};
  EXPECT_FLOAT_EQ(mean_of_largest(one, 0.5), 0.3f);
}

}  // namespace
}  // namespace waymark::test
