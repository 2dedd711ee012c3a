// SPDX-License-Identifier: Apache-2.0
// Heights of cameras as the only reference.
#include "pipeline/reconstruction/adjustment/frame_by_heights.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>

#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/adjustment/georeference.hpp"
#include "pipeline/reconstruction/adjustment/height_above_ground.hpp"
#include "tests/pipeline/reconstruction/made_scene.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;
using ::testing::HasSubstr;

// An aerial block in a frame of its own, with upward directions.
struct LooseBlock {
  MadeScene made;
  Observations seen;
};

LooseBlock loose_block(std::uint64_t seed, double relief, double climb) {
  LooseBlock block{.made = made_scene({.seed = seed, .relief = relief, .points = 800}), .seen = {}};
  MadeScene& made = block.made;
  if (climb > 0) {
    // Lines at different heights: the marks are made again.
    Random random(seed, "climb");
    for (std::size_t i = 0; i < made.truth.images.size(); ++i) {
      made.truth.images[i].world_from_camera->translation().z() += climb * double(i / 4);
      made.start.images[i].world_from_camera->translation().z() += climb * double(i / 4);
    }
    for (std::size_t k = 0; k < made.truth.points.size(); ++k)
      made.start.points[k].marks = made.truth.points[k].marks =
          marks_of(made.truth, *made.truth.points[k].position, 0.5, random);
  }
  Random random(seed, "ups");
  for (std::size_t i = 0; i < made.truth.images.size(); ++i) {
    const Eigen::Vector3d up =
        made.truth.images[i].world_from_camera->linear().transpose() * Eigen::Vector3d::UnitZ();
    block.seen.ups.push_back({i, (up + normal_vector(random, 0.002)).normalized(), 0.002});
  }
  Similarity away;
  away.scale = 0.037;
  away.rotation = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  away.shift = {3, 1, -2};
  transform(made.start, 0, away);
  made.start.frame = ReconstructionFrame::arbitrary;
  return block;
}

// Readings over the true ground.
std::vector<ObservedHeightAboveGround> readings_over(const MadeScene& made, double relief, double sd,
                                                     std::uint64_t seed) {
  Random random(seed, "altimeter");
  std::vector<ObservedHeightAboveGround> out;
  for (std::size_t i = 0; i < made.truth.images.size(); ++i) {
    const Eigen::Vector3d c = made.truth.images[i].world_from_camera->translation();
    out.push_back({i, c.z() - ground(c.x(), c.y(), relief) + random.normal(0, sd), sd});
  }
  return out;
}

// Ratio of the mean distance between cameras to the true one.
double size_of(const Reconstruction& found, const Reconstruction& truth) {
  double here = 0, there = 0;
  for (std::size_t i = 0; i < found.images.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto apart = [&](const Reconstruction& scene) {
        return (scene.images[i].world_from_camera->translation() -
                scene.images[j].world_from_camera->translation())
            .norm();
      };
      here += apart(found), there += apart(truth);
    }
  return here / there;
}

TEST(GroundBelow, IsThePlaneOfThePointsAtTheNadir) {
  const MadeScene made = made_scene({.relief = 3, .points = 1500});
  double squares = 0, expected = 0;
  for (std::size_t i = 0; i < made.truth.images.size(); ++i) {
    const Eigen::Vector3d c = made.truth.images[i].world_from_camera->translation();
    const auto below = ground_below(made.truth, i);
    ASSERT_TRUE(below);
    squares += std::pow(below->height - ground(c.x(), c.y(), 3), 2);
    expected += below->sd * below->sd;
  }
  std::printf("ground below: error %.3f m, stated %.3f m\n", std::sqrt(squares / 12),
              std::sqrt(expected / 12));
  EXPECT_LT(squares, 2 * expected);
  EXPECT_GT(squares, 0.1 * expected);
  Reconstruction bare = made.truth;
  for (TiePoint& point : bare.points) point.position->x() += 500;
  EXPECT_FALSE(ground_below(bare, 0));
}

TEST(FrameByHeights, HeightsAboveGroundGiveTheTrueSize) {
  double chi2 = 0;
  constexpr int kScenes = 20;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    LooseBlock block = loose_block(seed, 3, 0);
    block.seen.heights_above_ground = readings_over(block.made, 3, 0.5, seed);
    const FrameByHeightsResult placed = frame_by_heights(block.made.start, block.seen, 0);
    ASSERT_TRUE(placed.found) << placed.message;
    Reconstruction scene = block.made.start;
    transform(scene, 0, placed.found->local_from_frame);
    const double start = size_of(scene, block.made.truth);
    EXPECT_NEAR(start, 1, 0.03) << "seed " << seed;
    AdjustmentOptions options;
    options.robust = false;
    const AdjustmentResult adjusted = adjust(scene, block.seen, options);
    EXPECT_EQ(adjusted.free_datum, 4);  // position and direction
    const double size = size_of(scene, block.made.truth);
    EXPECT_NEAR(size, 1, 4 * placed.found->scale_sd) << "seed " << seed;
    chi2 += std::pow((size - 1) / placed.found->scale_sd, 2) / kScenes;
    // Level, the upper edge of the first image to the north.
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
      const Eigen::Vector3d up =
          scene.images[i].world_from_camera->linear() *
          (block.made.truth.images[i].world_from_camera->linear().transpose() * Eigen::Vector3d::UnitZ());
      EXPECT_GT(up.z(), 0.9999);
    }
    EXPECT_LT(std::abs(scene.images[0].world_from_camera->linear()(0, 1)), 0.02);
  }
  std::printf("scale: squared errors by stated variance %.2f\n", chi2);
  EXPECT_LT(chi2, 1.6);
  EXPECT_GT(chi2, 0.1);  // the adjustment is better than the start, whose deviation is stated
}

TEST(FrameByHeights, OtherHeightsGiveItIfTheyDiffer) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    LooseBlock block = loose_block(seed, 3, 25);
    for (std::size_t i = 0; i < block.made.truth.images.size(); ++i)
      block.seen.heights.push_back(
          {i, block.made.truth.images[i].world_from_camera->translation().z() + 420, 0.5, true});
    const FrameByHeightsResult placed = frame_by_heights(block.made.start, block.seen, 0);
    ASSERT_TRUE(placed.found) << placed.message;
    Reconstruction scene = block.made.start;
    transform(scene, 0, placed.found->local_from_frame);
    adjust(scene, block.seen);
    EXPECT_NEAR(size_of(scene, block.made.truth), 1, 0.02) << "seed " << seed;
  }
  LooseBlock flat = loose_block(1, 3, 0);
  for (std::size_t i = 0; i < flat.made.truth.images.size(); ++i)
    flat.seen.heights.push_back({i, 100, 0.5, true});
  const FrameByHeightsResult none = frame_by_heights(flat.made.start, flat.seen, 0);
  EXPECT_FALSE(none.found);
  EXPECT_THAT(none.message, HasSubstr("give its scale only within"));
}

TEST(FrameByHeights, OneReadingIsTooFew) {
  LooseBlock block = loose_block(1, 3, 0);
  block.seen.heights_above_ground = readings_over(block.made, 3, 0.5, 1);
  block.seen.heights_above_ground.resize(1);
  EXPECT_THAT(frame_by_heights(block.made.start, block.seen, 0).message, HasSubstr("and 2 are needed"));
}

TEST(FrameByHeights, AWrongReadingIsLeftOut) {
  LooseBlock block = loose_block(2, 3, 0);
  block.seen.heights_above_ground = readings_over(block.made, 3, 0.5, 2);
  block.seen.heights_above_ground[3].height += 40;
  const FrameByHeightsResult placed = frame_by_heights(block.made.start, block.seen, 0);
  ASSERT_TRUE(placed.found) << placed.message;
  Reconstruction scene = block.made.start;
  transform(scene, 0, placed.found->local_from_frame);
  const AdjustmentResult adjusted = adjust(scene, block.seen);
  for (const ObservationResult& one : adjusted.others)
    if (one.kind == "height above ground") {
      EXPECT_EQ(one.used, one.image != 3) << one.image;
    }
  EXPECT_NEAR(size_of(scene, block.made.truth), 1, 0.02);
}

}  // namespace
}  // namespace waymark::test
