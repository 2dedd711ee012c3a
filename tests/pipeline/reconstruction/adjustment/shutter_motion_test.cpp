// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/shutter_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/adjustment/georeference.hpp"
#include "pipeline/reconstruction/adjustment/triangulate.hpp"
#include "tests/pipeline/reconstruction/moving_scene.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;

/// Root mean square errors of poses, and their mean square against their covariance, per component.
struct MovingFigures {
  double position = 0, degrees = 0, chi2 = 0, sigma0 = 0, scenes = 0;

  void add(const Reconstruction& found, const Reconstruction& truth) {
    double metres = 0, radians = 0, squares = 0;
    const auto count = double(found.images.size());
    for (std::size_t i = 0; i < found.images.size(); ++i) {
      const auto error = pose_error(found.images[i], truth.images[i]);
      radians += error.head<3>().squaredNorm() / count;
      metres += error.tail<3>().squaredNorm() / count;
      squares += error.dot(found.images[i].covariance->ldlt().solve(error)) / 6 / count;
    }
    ++scenes;
    position += metres, degrees += radians, chi2 += squares, sigma0 += found.sigma0;
  }
  void finish(const char* what) {
    position = std::sqrt(position / scenes), degrees = std::sqrt(degrees / scenes) * 180 / std::numbers::pi;
    chi2 /= scenes, sigma0 /= scenes;
    std::printf("%-28s position %.4f m, rotation %.4f deg, chi2 %.3f, sigma0 %.3f\n", what, position, degrees,
                chi2, sigma0);
  }
};

Observations seen_positions(const MadeScene& made, std::uint64_t seed) {
  return {.positions = made_positions(made.truth, 0.1, seed)};
}

AdjustmentOptions keep_all() {
  AdjustmentOptions options;
  options.robust = false;
  return options;
}

TEST(ShutterMotion, ExactMarksGiveTheTruth) {
  MadeScene made = moving_scene({.mark_sd = 0});
  Observations seen{.positions = made_positions(made.truth, 0, 7)};
  for (auto& p : seen.positions) p.sd.setConstant(0.1);
  EXPECT_TRUE(adjust(made.start, seen, keep_all()).converged);
  for (std::size_t i = 0; i < made.truth.images.size(); ++i) {
    // The expected motions have errors, but less and less weight.
    const auto error = pose_error(made.start.images[i], made.truth.images[i]);
    EXPECT_LT(error.head<3>().norm(), 5e-5) << i;
    EXPECT_LT(error.tail<3>().norm(), 5e-3) << i;
  }
}

// The twin projects by fixed-point iteration, and knows nothing of the terms of the adjustment.
TEST(ShutterMotion, ProjectsAsTheSlowIteration) {
  const MadeScene made = moving_scene({.seed = 3, .readout_time = 0.5, .mark_sd = 0});
  std::size_t count = 0;
  for (const TiePoint& point : made.truth.points) {
    for (const Mark& mark : point.marks) {
      const Eigen::Isometry3d pose = pose_of_mark(made.truth, mark);
      const auto seen = project(made.truth.lenses[0].camera, {pose.inverse() * *point.position});
      ASSERT_TRUE(seen);
      EXPECT_LT((*seen - mark.pixel).norm(), 1e-6);
      ++count;
    }
    const auto placed = triangulate(made.truth, point.marks);
    if (placed) {
      EXPECT_LT((placed->position - *point.position).norm(), 1e-5);
    }
  }
  EXPECT_GT(count, 1000u);
}

TEST(ShutterMotion, NeighboursGiveTheMotion) {
  const MadeScene made = moving_scene({});
  const auto expected = expected_motions(made.truth);
  double shift = 0, turn = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_TRUE(expected[i]);
    const ShutterMotion& truth = *made.truth.images[i].motion;
    shift += (expected[i]->motion.shift - truth.shift).squaredNorm() / 3 / std::pow(expected[i]->shift_sd, 2);
    turn += (expected[i]->motion.turn - truth.turn).squaredNorm() / 3 / std::pow(expected[i]->turn_sd, 2);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& [image, factor] : expected[i]->centres)
      sum += factor * made.truth.images[image].world_from_camera->translation();
    EXPECT_LT((sum - expected[i]->motion.shift).norm(), 1e-9);
  }
  shift /= double(expected.size()), turn /= double(expected.size());
  std::printf("squared errors by variance: shift %.3f, turn %.3f\n", shift, turn);
  EXPECT_LT(shift, 1.5);    // deviations are not too small, nor useless
  EXPECT_GT(shift, 0.005);  // so smooth a path is followed better than third differences state
  EXPECT_LT(turn, 1.5);
  EXPECT_GT(turn, 0.1);
}

TEST(ShutterMotion, WithoutTimesOrReadoutThereIsNone) {
  MadeScene made = moving_scene({});
  Reconstruction no_times = made.start;
  for (AdjustedImage& image : no_times.images) image.time.reset();
  EXPECT_EQ(expect_motions(no_times), 0u);
  Reconstruction global = made.start;
  global.lenses[0].readout_time = 0;
  EXPECT_EQ(expect_motions(global), 0u);
  Reconstruction same_time = made.start;
  for (AdjustedImage& image : same_time.images) image.time = 5;
  EXPECT_EQ(expect_motions(same_time), 0u);
  EXPECT_EQ(expect_motions(made.start), made.start.images.size());
}

TEST(ShutterMotion, TurnsAndGrowsWithTheFrame) {
  MadeScene made = moving_scene({.seed = 4});
  Reconstruction moved = made.truth;
  Similarity similarity;
  similarity.scale = 3;
  similarity.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  similarity.shift = {5, -6, 7};
  transform(moved, 0, similarity);
  for (const TiePoint& point : moved.points)
    for (const Mark& mark : point.marks) {
      const auto seen =
          project(moved.lenses[0].camera, {pose_of_mark(moved, mark).inverse() * *point.position});
      ASSERT_TRUE(seen);
      const auto before = project(
          made.truth.lenses[0].camera,
          {pose_of_mark(made.truth, mark).inverse() *
           (similarity.rotation.transpose() * (*point.position - similarity.shift) / similarity.scale)});
      EXPECT_LT((*seen - *before).norm(), 1e-7);
    }
  Reconstruction loose = made.start;
  EXPECT_EQ(adjust(loose, {}, keep_all()).free_datum, 7);  // expected motions hold no frame
  const auto length = [](const Reconstruction& scene) {
    return (scene.images.back().world_from_camera->translation() -
            scene.images[0].world_from_camera->translation())
        .norm();
  };
  EXPECT_NEAR(length(loose) / length(made.start), 1, 0.1);  // nor do they draw it together
}

// Poses without the model, with the motions that neighbours predict, and with estimated motions.
TEST(ShutterMotion, EstimatedMotionsGiveTheBestPosesAndTrueCovariances) {
  for (const double wobble : {0.0, 0.05}) {
    MovingFigures none, held, estimated;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const MadeScene made = moving_scene({.seed = seed, .wobble = wobble});
      const Observations seen = seen_positions(made, seed + 100);
      Reconstruction scene = made.start;
      scene.lenses[0].readout_time = 0;
      adjust(scene, seen, keep_all());
      none.add(scene, made.truth);
      scene = made.start;
      AdjustmentOptions fixed = keep_all();
      fixed.estimate_motions = false;
      for (int round = 0; round < 3; ++round) {
        for (AdjustedImage& image : scene.images) image.motion.reset();
        expect_motions(scene);
        adjust(scene, seen, fixed);
      }
      held.add(scene, made.truth);
      scene = made.start;
      adjust(scene, seen, keep_all());
      estimated.add(scene, made.truth);
    }
    std::printf("turns of %.2f rad/s that no neighbour shows\n", wobble);
    none.finish("  global shutter");
    held.finish("  motions of the neighbours");
    estimated.finish("  motions estimated");
    EXPECT_LT(estimated.position, 0.5 * none.position);
    EXPECT_LT(estimated.degrees, 0.5 * none.degrees);
    EXPECT_LT(estimated.position, 1.02 * held.position);
    EXPECT_GT(estimated.chi2, 0.8);
    EXPECT_LT(estimated.chi2, 1.25);
    EXPECT_NEAR(estimated.sigma0, 1, 0.05);
  }
}

}  // namespace
}  // namespace waymark::test
