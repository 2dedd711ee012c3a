// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/adjust.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/error.hpp"
#include "tests/pipeline/reconstruction/made_scene.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;
using ::testing::HasSubstr;

// Mean of error^T covariance^-1 error / 6.
double pose_chi2(const Reconstruction& found, const Reconstruction& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < found.images.size(); ++i) {
    const auto error = pose_error(found.images[i], truth.images[i]);
    sum += error.dot(found.images[i].covariance->ldlt().solve(error)) / 6;
  }
  return sum / static_cast<double>(found.images.size());
}

TEST(Adjust, ExactMarksGiveTheTruth) {
  MadeScene made = made_scene({.mark_sd = 0, .corner = {999000, 5123000, 140}});
  Observations seen{.positions = made_positions(made.truth, 0, 7)};
  for (auto& p : seen.positions) p.sd.setConstant(0.1);
  const AdjustmentResult found = adjust(made.start, seen);
  EXPECT_TRUE(found.converged);
  EXPECT_LT(found.sigma0, 1e-6);
  EXPECT_EQ(found.removed.size(), 0u);
  for (std::size_t i = 0; i < made.truth.images.size(); ++i)
    EXPECT_LT(pose_error(made.start.images[i], made.truth.images[i]).norm(), 1e-6);
}

// The scale of the covariances is the question, so nothing is removed: 3 sigma would clip good marks.
TEST(Adjust, CovariancesPassTheChiSquareTest) {
  double poses = 0, points = 0, count = 0, sigma0 = 0, lens = 0;
  constexpr int kScenes = 20;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    MadeScene made = made_scene({.seed = seed, .tilt = 0.25});
    Observations seen{.positions = made_positions(made.truth, 0.3, seed + 100)};
    made.start.lenses[0].camera.fx = made.start.lenses[0].camera.fy = 1010;
    AdjustmentOptions options;
    options.robust = false;
    options.free_lens_parameters = {{"f", "k1"}};
    const AdjustmentResult found = adjust(made.start, seen, options);
    sigma0 += found.sigma0 / kScenes;
    poses += pose_chi2(made.start, made.truth) / kScenes;
    const Eigen::Vector2d error(made.start.lenses[0].camera.fx - 1000,
                                made.start.lenses[0].camera.distortion[0]);
    lens += error.dot(made.start.lenses[0].covariance.ldlt().solve(error)) / 2 / kScenes;
    for (std::size_t i = 0; i < made.start.points.size(); ++i) {
      const Eigen::Vector3d miss = *made.start.points[i].position - *made.truth.points[i].position;
      points += miss.dot(made.start.points[i].covariance->ldlt().solve(miss)) / 3;
      ++count;
    }
  }
  std::printf("chi2 per freedom: poses %.3f, points %.3f, lens %.3f; sigma0 %.4f\n", poses, points / count,
              lens, sigma0);
  EXPECT_NEAR(sigma0, 1, 0.02);
  EXPECT_GT(poses, 0.8);
  EXPECT_LT(poses, 1.25);
  EXPECT_GT(points / count, 0.8);
  EXPECT_LT(points / count, 1.25);
  EXPECT_GT(lens, 0.4);  // 40 freedoms: 99 % of chi2 / 40 lie between 0.55 and 1.6
  EXPECT_LT(lens, 1.7);
}

TEST(Adjust, OrderOfTheInputDoesNotMatter) {
  const MadeScene made = made_scene({.seed = 5});
  const Observations seen{.positions = made_positions(made.truth, 0.3, 8)};
  Reconstruction straight = made.start;
  adjust(straight, seen);
  // Image i becomes image (5 i + 3) mod n; points and marks are reversed.
  const std::size_t n = made.start.images.size();
  const auto moved = [&](std::size_t i) { return (5 * i + 3) % n; };
  Reconstruction shuffled = made.start;
  for (std::size_t i = 0; i < n; ++i) shuffled.images[moved(i)] = made.start.images[i];
  std::ranges::reverse(shuffled.points);
  for (TiePoint& p : shuffled.points) {
    std::ranges::reverse(p.marks);
    for (Mark& m : p.marks) m.image = moved(m.image);
  }
  Observations moved_seen = seen;
  for (auto& p : moved_seen.positions) p.image = moved(p.image);
  adjust(shuffled, moved_seen);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(shuffled.images[moved(i)].world_from_camera->matrix(),
              straight.images[i].world_from_camera->matrix());
    EXPECT_EQ(*shuffled.images[moved(i)].covariance, *straight.images[i].covariance);
  }
  for (std::size_t i = 0; i < straight.points.size(); ++i)
    EXPECT_EQ(*shuffled.points[straight.points.size() - 1 - i].position, *straight.points[i].position);
}

TEST(Adjust, ACheckPointNeverMovesTheSolution) {
  const MadeSceneOptions options{.seed = 6};
  const MadeScene made = made_scene(options);
  Observations seen{.control = made_control(made, options, 3, 2, 0.02)};
  Reconstruction without = made.start, with = made.start;
  adjust(without, seen);
  seen.control.push_back(seen.control[0]);
  seen.control.back().name = "A";  // before all others
  seen.control.back().check = true;
  seen.control.back().position += Eigen::Vector3d(1, 2, 3);
  const AdjustmentResult found = adjust(with, seen);
  for (std::size_t i = 0; i < with.images.size(); ++i)
    EXPECT_EQ(with.images[i].world_from_camera->matrix(), without.images[i].world_from_camera->matrix());
  const ControlResult& check = found.control.back();
  EXPECT_TRUE(check.check);
  EXPECT_FALSE(check.used);
  ASSERT_TRUE(check.position);
  EXPECT_LT((check.error + Eigen::Vector3d(1, 2, 3)).norm(), 0.2);
  EXPECT_GT(check.statistic, 4);
}

TEST(Adjust, OutliersLeaveTheTiePoints) {
  MadeScene made = made_scene({.seed = 9});
  std::size_t wrong = 0, marks = 0;
  for (std::size_t i = 0; i < made.start.points.size(); ++i) {
    auto& of = made.start.points[i].marks;
    marks += of.size();
    if (i % 5 == 0) of[i % of.size()].pixel += Eigen::Vector2d(20, i % 2 == 0 ? 30 : -30), ++wrong;
  }
  Observations seen{.positions = made_positions(made.truth, 0.3, 11)};
  const AdjustmentResult found = adjust(made.start, seen);
  std::size_t caught = 0;
  for (const RemovedMark& m : found.removed) caught += m.residual > 10;
  EXPECT_GE(caught, wrong * 9 / 10);  // of two marks, which one is wrong may remain open
  EXPECT_LE(found.removed.size(), wrong * 5 / 4 + marks / 50);
  EXPECT_NEAR(found.sigma0, 1, 0.1);
  EXPECT_LT(pose_chi2(made.start, made.truth), 1.6);
}

TEST(Adjust, AWrongPositionIsNamed) {
  MadeScene made = made_scene({.seed = 12});
  Observations seen{.positions = made_positions(made.truth, 0.3, 13)};
  seen.positions[4].position += Eigen::Vector3d(8, -3, 4);
  const AdjustmentResult found = adjust(made.start, seen);
  for (std::size_t i = 0; i < seen.positions.size(); ++i) EXPECT_EQ(found.others[i].used, i != 4) << i;
  EXPECT_LT(pose_chi2(made.start, made.truth), 1.6);
}

// Every second image is left out: standard deviations of what remains may only grow.
TEST(Adjust, HalfTheOverlapIsNeverMoreAccurate) {
  for (std::uint64_t seed = 20; seed < 24; ++seed) {
    const MadeScene made = made_scene({.seed = seed, .columns = 6});
    Reconstruction all = made.start, half = made.start;
    for (std::size_t i = 1; i < half.images.size(); i += 2) half.images[i].world_from_camera.reset();
    const Observations seen{.positions = made_positions(made.truth, 0.3, seed)};
    AdjustmentOptions options;
    options.robust = false;
    adjust(all, seen, options);
    adjust(half, seen, options);
    for (std::size_t i = 0; i < half.images.size(); i += 2) {
      const auto many = all.images[i].covariance->diagonal() / std::pow(all.sigma0, 2);
      const auto few = half.images[i].covariance->diagonal() / std::pow(half.sigma0, 2);
      EXPECT_TRUE((few.array() >= many.array()).all()) << "seed " << seed << ", image " << i;
    }
  }
}

TEST(Adjust, AHeightBiasIsEstimated) {
  MadeScene made = made_scene({.seed = 31});
  Observations seen{.positions = made_positions(made.truth, 0.1, 14)};
  for (auto& p : seen.positions) p.sd.z() = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < made.truth.images.size(); ++i)
    seen.heights.push_back({i, made.truth.images[i].world_from_camera->translation().z() + 42, 0.1});
  const MadeSceneOptions options{.seed = 31};
  seen.control = made_control(made, options, 2, 2, 0.02);
  const AdjustmentResult found = adjust(made.start, seen);
  EXPECT_EQ(found.free_datum, 0);
  EXPECT_NEAR(found.height_bias, 42, 4 * found.height_bias_sd);
  EXPECT_LT(found.height_bias_sd, 0.2);
  // Without control the bias and the height of the frame cannot be separated.
  seen.control.clear();
  const AdjustmentResult loose = adjust(made.start, seen);
  EXPECT_EQ(loose.free_datum, 1);
}

// A control point without a height still fixes its place in plan; one with a single mark cannot be placed.
TEST(Adjust, HeightsOfControlMayBeUnknown) {
  const MadeSceneOptions options{.seed = 41};
  MadeScene made = made_scene(options);
  Observations seen{.control = made_control(made, options, 3, 2, 0.02)};
  for (const std::size_t i : {0u, 4u}) {
    seen.control[i].position.z() = std::nan("");
    seen.control[i].sd.z() = std::numeric_limits<double>::infinity();
  }
  seen.control[4].marks.resize(1);
  const AdjustmentResult found = adjust(made.start, seen);
  EXPECT_EQ(found.free_datum, 0);
  EXPECT_TRUE(found.control[0].used);
  EXPECT_LT(found.control[0].error.head<2>().norm(), 0.1);
  EXPECT_FALSE(found.control[4].used);
  EXPECT_THAT(found.control[4].note, HasSubstr("marks in two or more images"));
}

TEST(Adjust, CountsTheFreedomsOfTheFrame) {
  const MadeScene made = made_scene({.seed = 33});
  const auto free = [&](const Observations& seen, AdjustmentOptions options = {}) {
    Reconstruction scene = made.start;
    return adjust(scene, seen, options).free_datum;
  };
  EXPECT_EQ(free({}), 7);
  AdjustmentOptions one;
  one.fixed_images = {0};
  EXPECT_EQ(free({}, one), 1);  // scale
  const auto positions = made_positions(made.truth, 0.3, 3);
  EXPECT_EQ(free({.positions = {positions[0]}}), 4);
  EXPECT_EQ(free({.positions = {positions[0], positions[5]}}), 1);  // the turn about their line
  EXPECT_EQ(free({.positions = {positions[0], positions[5]}, .ups = {{0, {0, 0, -1}, 0.05}}}), 0);
  EXPECT_EQ(free({.positions = positions}), 0);
}

TEST(Adjust, SaysWhichLensParametersThereAre) {
  MadeScene made = made_scene({});
  AdjustmentOptions options;
  options.free_lens_parameters = {{"k9"}};
  try {
    adjust(made.start, {}, options);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("lens 0 has no parameter 'k9'"));
    EXPECT_THAT(e.what(), HasSubstr("f, aspect, cx, cy, k1, k2, k3, p1, p2"));
  }
}

TEST(Adjust, NothingPosedIsAnError) {
  MadeScene made = made_scene({});
  for (AdjustedImage& image : made.start.images) image.world_from_camera.reset();
  try {
    adjust(made.start, {});
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("no image has a pose"));
  }
}

}  // namespace
}  // namespace waymark::test
