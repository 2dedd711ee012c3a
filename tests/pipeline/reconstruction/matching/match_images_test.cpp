// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/match_images.hpp"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/pipeline/reconstruction/made_pictures.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

ImageMatches matched(const MadeGround& ground, const std::vector<PosedCamera>& views,
                     double focal_sd = 0.01) {
  std::vector<ImageToMatch> images;
  std::vector<ImageFeatures> features;
  for (const PosedCamera& view : views) {
    images.push_back({.name = "made_" + std::to_string(images.size())});
    features.push_back(find_features(made_picture(ground, view), {}));
  }
  const LensGuess lens{.camera = views[0].camera, .focal_sd = focal_sd};
  return match_images(images, features, std::span(&lens, 1), {});
}

Eigen::Isometry3d second_from_first(const PosedCamera& first, const PosedCamera& second) {
  return second.grid_from_camera.transform.inverse() * first.grid_from_camera.transform;
}

// Worst disagreement of the best of the poses, degrees.
double pose_error(const PairGeometry& found, const PosedCamera& first, const PosedCamera& second) {
  const Eigen::Isometry3d truth = second_from_first(first, second);
  double best = 180;
  for (const RelativePose& pose : found.poses) {
    const double turn = Eigen::AngleAxisd(pose.rotation * truth.linear().transpose()).angle();
    const double direction =
        pose.direction.isZero()
            ? 0
            : std::acos(std::clamp(pose.direction.dot(truth.translation().normalized()), -1.0, 1.0));
    best = std::min(best, std::max(turn, direction) / kDegree);
  }
  return best;
}

TEST(MatchImages, ReliefSeenFromTheSideIsGeneral) {
  const Camera camera = made_camera(500, 400, 60);
  const std::vector<PosedCamera> views{made_view(camera, {0, 0, 60}, 0, 0),
                                       made_view(camera, {12, 3, 62}, 5, 30)};
  const ImageMatches found = matched({.relief = 6}, views);
  ASSERT_EQ(found.pairs.size(), 1u);
  EXPECT_EQ(found.pairs[0].geometry.kind, PairKind::general);
  EXPECT_LT(pose_error(found.pairs[0].geometry, views[0], views[1]), 1.0);
}

TEST(MatchImages, LevelGroundIsPlanar) {
  const Camera camera = made_camera(500, 400, 60);
  const std::vector<PosedCamera> views{made_view(camera, {0, 0, 60}, 0, 0),
                                       made_view(camera, {12, 3, 55}, 8, 0)};
  const ImageMatches found = matched({}, views);
  ASSERT_EQ(found.pairs.size(), 1u);
  EXPECT_EQ(found.pairs[0].geometry.kind, PairKind::planar);
  EXPECT_LT(pose_error(found.pairs[0].geometry, views[0], views[1]), 2.0);
}

TEST(MatchImages, ATurnedCameraIsARotation) {
  const Camera camera = made_camera(500, 400, 60);
  const std::vector<PosedCamera> views{made_view(camera, {0, 0, 60}, 0, 0),
                                       made_view(camera, {0, 0, 60}, 8, 90, 20)};
  const ImageMatches found = matched({.relief = 6}, views);
  ASSERT_EQ(found.pairs.size(), 1u);
  EXPECT_EQ(found.pairs[0].geometry.kind, PairKind::rotation);
  EXPECT_LT(pose_error(found.pairs[0].geometry, views[0], views[1]), 0.1);
}

TEST(MatchImages, ADescentToAQuarterOfTheHeightIsForward) {
  const Camera camera = made_camera(900, 900, 60);
  const std::vector<PosedCamera> views{made_view(camera, {0, 0, 160}, 0, 0),
                                       made_view(camera, {1, 0, 40}, 0, 0, 10)};
  const ImageMatches found = matched({.relief = 6}, views);
  ASSERT_EQ(found.pairs.size(), 1u);
  EXPECT_EQ(found.pairs[0].geometry.kind, PairKind::forward);
  EXPECT_LT(pose_error(found.pairs[0].geometry, views[0], views[1]), 1.0);
}

TEST(MatchImages, OtherGroundDoesNotMatch) {
  const Camera camera = made_camera(500, 400, 60);
  const std::vector<PosedCamera> views{made_view(camera, {0, 0, 60}, 0, 0),
                                       made_view(camera, {900, 0, 60}, 0, 0)};
  EXPECT_TRUE(matched({.relief = 6}, views).pairs.empty());
}

TEST(MatchImages, ThreadsDoNotChangeTheResult) {
  const Camera camera = made_camera(300, 300, 60);
  std::vector<PosedCamera> views;
  for (int i = 0; i < 4; ++i) views.push_back(made_view(camera, {6.0 * i, 2.0 * i, 50}, 3, 20.0 * i));
  std::vector<ImageMatches> runs;
  for (const std::size_t threads : {1, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    runs.push_back(matched({.relief = 5}, views));
  }
  ASSERT_EQ(runs[0].pairs.size(), runs[1].pairs.size());
  for (std::size_t p = 0; p < runs[0].pairs.size(); ++p) {
    EXPECT_EQ(runs[0].pairs[p].geometry.inliers, runs[1].pairs[p].geometry.inliers);
    EXPECT_EQ(runs[0].pairs[p].geometry.poses[0].rotation, runs[1].pairs[p].geometry.poses[0].rotation);
  }
}

TEST(MatchImages, TheVehicleInViewIsNoPartOfTheScene) {
  ImageFeatures a, b;
  for (int i = 0; i < 30; ++i) {
    a.features.push_back({.pixel = {10.0 * i, 50}});
    b.features.push_back({.pixel = {10.0 * i + (i < 20 ? 25.0 : 0.2), 50}});
  }
  std::vector<Match> matches;
  for (std::uint32_t i = 0; i < 30; ++i) matches.push_back({i, i});
  EXPECT_EQ(without_static(matches, a, b).size(), 20u);
  // A picture taken twice from the same place keeps its matches.
  EXPECT_EQ(without_static(matches, a, a).size(), 30u);
}

}  // namespace
}  // namespace waymark::test
