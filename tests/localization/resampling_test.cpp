// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/resampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/random.hpp"
#include "localization/filters/particle_weights.hpp"

namespace waymark::test {
using namespace localization;
namespace {

TEST(Resampling, RedrawnParticlesKeepMeanAndCovarianceAndAreNoCopies) {
  Random random(5);
  std::vector<Pose2> poses;
  std::vector<double> weights;
  for (int i = 0; i < 2000; ++i) {
    poses.push_back({100 + random.normal(), 0.3 * random.normal(), wrap_angle(3.1 + 0.1 * random.normal())});
    weights.push_back(std::exp(-2 * poses.back().y));
  }
  double total = 0;
  for (const double w : weights) total += w;
  for (double& w : weights) w /= total;
  const PoseEstimate before = moments(poses, weights);
  const std::vector<Pose2> after = resample_regularized(poses, weights, before, 2000, random);
  const PoseEstimate now = moments(after, std::vector<double>(2000, 1.0 / 2000));
  EXPECT_NEAR(now.pose.x, before.pose.x, 0.1);
  EXPECT_NEAR(now.pose.y, before.pose.y, 0.03);
  EXPECT_NEAR(wrap_angle(now.pose.yaw - before.pose.yaw), 0, 0.01);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(now.covariance(i, i) / before.covariance(i, i), 1, 0.15) << i;
  std::set<double> different;
  for (const Pose2& p : after) different.insert(p.x);
  EXPECT_EQ(different.size(), after.size());
}

TEST(Resampling, TemperingKeepsEnoughParticles) {
  const std::vector<double> weights(100, 0.01);
  std::vector<double> fit;
  for (int i = 0; i < 100; ++i) fit.push_back(-0.5 * i);
  EXPECT_EQ(temper_weights(weights, fit, 0.01, 50).exponent, 0.01);
  const TemperedWeights tempered = temper_weights(weights, fit, 1, 50);
  EXPECT_LT(tempered.exponent, 0.2);
  std::vector<double> after = fit;
  for (double& f : after) f *= tempered.exponent;
  const double left = effective_sample_size(normalise_log_weights(after));
  EXPECT_GE(left, 50);
  EXPECT_LT(left, 51);
  for (std::size_t i = 0; i < after.size(); ++i)
    EXPECT_NEAR(tempered.weights[i], normalise_log_weights(after)[i], 1e-12) << i;
}

// The slow twin bisects. Fits of clouds in three dimensions, from vague to precise, with a floor as by
// clutter.
TEST(Resampling, TemperingMatchesBisection) {
  Random random(8);
  const std::vector<double> weights(400, 1.0 / 400);
  for (const double precise : {0.3, 3.0, 30.0, 300.0, 3e4}) {
    std::vector<double> fit;
    for (int i = 0; i < 400; ++i) {
      const double a = random.normal() + 0.5, b = random.normal(), c = random.normal();
      fit.push_back(std::log(std::exp(-precise * (a * a + 0.3 * b * b + 0.1 * c * c)) + 1e-9) - 700);
    }
    const auto bears = [&](double part, double least) {
      std::vector<double> after = fit;
      for (double& f : after) f *= part;
      return effective_sample_size(normalise_log_weights(after)) >= least;
    };
    double low = 0, high = 1;
    for (int i = 0; i < 40 && !bears(high, 200); ++i) {
      const double middle = (low + high) / 2;
      (bears(middle, 200) ? low : high) = middle;
    }
    const TemperedWeights tempered = temper_weights(weights, fit, 1, 200);
    EXPECT_TRUE(bears(tempered.exponent, 200)) << precise;
    EXPECT_NEAR(tempered.exponent, bears(1, 200) ? 1 : low, 0.05 * tempered.exponent) << precise;
  }
}

TEST(Resampling, HopelessAndEqualFitsNeedNoTempering) {
  const std::vector<double> weights(10, 0.1);
  EXPECT_EQ(temper_weights(weights, std::vector<double>(10, -1e5), 1, 5).exponent, 1);
  const std::vector<double> one{1, 0, 0, 0};
  EXPECT_EQ(temper_weights(one, std::vector<double>{-1, 0, -2, 0}, 1, 2).exponent, 0) << "too few before";
}

}  // namespace
}  // namespace waymark::test
