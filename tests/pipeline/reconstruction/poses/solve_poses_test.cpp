// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/poses/solve_poses.hpp"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <Eigen/Dense>
#include <numbers>

#include "core/random.hpp"
#include "pipeline/reconstruction/poses/resection.hpp"
#include "pipeline/reconstruction/poses/thin_tracks.hpp"
#include "tests/pipeline/reconstruction/made_pictures.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

struct Solved {
  SolvedPoses poses;
  std::vector<PosedCamera> truth;
};

// `exchanged`: the solutions of a pair with several come in the opposite order.
Solved solved(const MadeGround& ground, const std::vector<PosedCamera>& views, double focal_sd = 0,
              bool exchanged = false) {
  std::vector<ImageToMatch> images;
  std::vector<ImageFeatures> features;
  for (const PosedCamera& view : views) {
    images.push_back({.name = "made_" + std::to_string(images.size())});
    features.push_back(find_features(made_picture(ground, view), {}));
  }
  LensGuess lens{.camera = views[0].camera, .focal_sd = focal_sd};
  ImageMatches matches = match_images(images, features, std::span(&lens, 1), {});
  if (exchanged)
    for (MatchedPair& pair : matches.pairs) std::ranges::reverse(pair.geometry.poses);
  return {solve_poses(images, features, matches, {}), views};
}

// Root mean square error of the centres after a similarity fit, metres, and the largest error of a rotation.
struct PoseError {
  double position = 0, rotation = 0;
};

PoseError error_of(const Reconstruction& scene, const std::vector<PosedCamera>& truth) {
  std::vector<std::size_t> posed;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (scene.images[i].world_from_camera) posed.push_back(i);
  Eigen::Matrix3Xd from(3, posed.size()), to(3, posed.size());
  for (std::size_t k = 0; k < posed.size(); ++k) {
    from.col(static_cast<Eigen::Index>(k)) = scene.images[posed[k]].world_from_camera->translation();
    to.col(static_cast<Eigen::Index>(k)) = truth[posed[k]].centre().xyz;
  }
  const Eigen::Matrix4d fit = Eigen::umeyama(from, to, true);
  const double scale = std::cbrt(fit.topLeftCorner<3, 3>().determinant());
  const Eigen::Matrix3d turn = fit.topLeftCorner<3, 3>() / scale;
  PoseError error;
  for (std::size_t k = 0; k < posed.size(); ++k) {
    const Eigen::Vector3d at = (fit * from.col(static_cast<Eigen::Index>(k)).homogeneous()).head<3>();
    error.position += (at - to.col(static_cast<Eigen::Index>(k))).squaredNorm() / double(posed.size());
    const Eigen::Matrix3d off = turn * scene.images[posed[k]].world_from_camera->linear() *
                                truth[posed[k]].grid_from_camera.transform.linear().transpose();
    error.rotation = std::max(error.rotation, Eigen::AngleAxisd(off).angle() / kDegree);
  }
  error.position = std::sqrt(error.position);
  return error;
}

std::vector<PosedCamera> mapping_flight(const Camera& camera) {
  std::vector<PosedCamera> views;
  for (int line = 0; line < 2; ++line)
    for (int i = 0; i < 3; ++i)
      views.push_back(made_view(camera, {12.0 * i, 14.0 * line, 50.0 + i % 2}, 4.0 * (i - 1), 90.0 * line));
  return views;
}

TEST(SolvePoses, AMappingFlightIsPosed) {
  const Solved s = solved({.relief = 4}, mapping_flight(made_camera(500, 400, 60)));
  ASSERT_EQ(s.poses.components.size(), 1u);
  EXPECT_EQ(s.poses.components[0].posed, 6u);
  const PoseError error = error_of(s.poses.components[0].scene, s.truth);
  EXPECT_LT(error.position, 0.05);  // 0.1 % of the height
  EXPECT_LT(error.rotation, 0.1);
  for (const std::string& failure : s.poses.failures) EXPECT_EQ(failure, "");
}

TEST(SolvePoses, LevelGroundIsPosed) {
  const Solved s = solved({}, mapping_flight(made_camera(500, 400, 60)));
  ASSERT_GE(s.poses.components.size(), 1u);
  EXPECT_EQ(s.poses.components[0].posed, 6u);
  const PoseError error = error_of(s.poses.components[0].scene, s.truth);
  EXPECT_LT(error.position, 0.1);
  EXPECT_LT(error.rotation, 0.15);
}

TEST(SolvePoses, AVerticalDescentIsPosed) {
  const Camera camera = made_camera(600, 600, 60);
  std::vector<PosedCamera> views;
  for (int i = 0; i < 6; ++i)
    views.push_back(made_view(camera, {0.3 * i, -0.2 * i, 120 * std::pow(0.8, i)}, 0.5 * i, 0, 7.0 * i));
  const Solved s = solved({.relief = 6}, views);
  ASSERT_GE(s.poses.components.size(), 1u);
  EXPECT_EQ(s.poses.components[0].posed, 6u);
  EXPECT_LT(error_of(s.poses.components[0].scene, s.truth).position, 0.25);
}

// Six views along a line, ten degrees off the vertical.
std::vector<PosedCamera> oblique_descent() {
  const Camera camera = made_camera(500, 500, 75);
  std::vector<PosedCamera> views;
  for (int i = 0; i < 6; ++i) {
    const double height = 120 * std::pow(0.87, i);
    views.push_back(
        made_view(camera, {0.2 * (120 - height), -0.1 * (120 - height), height}, 2, 40.0 * i, 5.0 * i));
  }
  return views;
}

// Largest error of a rotation against that of the first image, degrees: centres on a line leave the rotation
// about it open.
double relative_rotation_error(const Reconstruction& scene, const std::vector<PosedCamera>& truth) {
  double largest = 0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Eigen::Matrix3d found =
        scene.images[0].world_from_camera->linear().transpose() * scene.images[i].world_from_camera->linear();
    const Eigen::Matrix3d expected = truth[0].grid_from_camera.transform.linear().transpose() *
                                     truth[i].grid_from_camera.transform.linear();
    largest = std::max(largest, Eigen::AngleAxisd(found.transpose() * expected).angle() / kDegree);
  }
  return largest;
}

// Seen along one line, a plane has a second solution, in which its normal and the motion are exchanged.
// Relief distinguishes them, whichever of the two a pair names first.
TEST(SolvePoses, AnObliqueDescentAlongALineTakesTheRightOfTwoSolutions) {
  for (const std::uint32_t seed : {1U, 2U})
    for (const bool exchanged : {false, true}) {
      const Solved s = solved({.relief = 1.3, .seed = seed}, oblique_descent(), 0, exchanged);
      ASSERT_GE(s.poses.components.size(), 1u);
      ASSERT_EQ(s.poses.components[0].posed, 6u);
      EXPECT_LT(relative_rotation_error(s.poses.components[0].scene, s.truth), 0.5) << seed << exchanged;
    }
}

TEST(SolvePoses, TwoSitesStayApart) {
  const Camera camera = made_camera(400, 300, 60);
  std::vector<PosedCamera> views;
  for (const double east : {0.0, 2000.0})
    for (int i = 0; i < 3; ++i) views.push_back(made_view(camera, {east + 9.0 * i, 2.0 * i, 40}, 2.0 * i, 0));
  views.pop_back();
  const Solved s = solved({.relief = 4}, views);
  ASSERT_EQ(s.poses.components.size(), 2u);
  EXPECT_EQ(s.poses.components[0].posed, 3u);
  EXPECT_EQ(s.poses.components[1].posed, 2u);
  EXPECT_FALSE(s.poses.components[0].scene.images[3].world_from_camera);
}

TEST(SolvePoses, AStrangerIsNamedWithAReason) {
  const Camera camera = made_camera(400, 300, 60);
  std::vector<PosedCamera> views;
  for (int i = 0; i < 3; ++i) views.push_back(made_view(camera, {9.0 * i, 2.0 * i, 40}, 2.0 * i, 0));
  views.push_back(made_view(camera, {5000, 0, 40}, 0, 0));
  const Solved s = solved({.relief = 4}, views);
  EXPECT_EQ(s.poses.components[0].posed, 3u);
  EXPECT_THAT(s.poses.failures[3], testing::HasSubstr("matches no other image"));
}

TEST(SolvePoses, CopiesAndTurnsOnTheSpotGiveNoPoses) {
  const Camera camera = made_camera(400, 300, 60);
  const PosedCamera view = made_view(camera, {0, 0, 40}, 0, 0);
  EXPECT_TRUE(solved({.relief = 4}, {view, view}).poses.components.empty());
  EXPECT_TRUE(
      solved({.relief = 4}, {view, made_view(camera, {0, 0, 40}, 6, 40, 10)}).poses.components.empty());
}

TEST(Resect, FindsThePoseAmongOutliers) {
  const Camera camera = made_camera(1000, 800, 60);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    const PosedCamera view = made_view(camera, {3, -2, 50}, 10, 70);
    std::vector<ImagedPoint> points;
    for (int i = 0; i < 150; ++i) {
      const Eigen::Vector3d at(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-3, 3));
      const auto pixel = project(view, Point<GridFrame>{at});
      if (!pixel) continue;
      points.push_back({at, *pixel + Eigen::Vector2d(random.normal(), random.normal())});
      if (i % 3 == 0) points.back().pixel = {random.uniform(0, 1000), random.uniform(0, 800)};
    }
    const auto found = resect(camera, points, {.seed = seed});
    ASSERT_TRUE(found) << "seed " << seed;
    EXPECT_LT((found->world_from_camera.translation() - view.centre().xyz).norm(), 0.3);
    EXPECT_GE(found->inliers.size(), 95u);
  }
}

TEST(Resect, FiveAgreeingPointsAreTooFew) {
  const std::vector<ImagedPoint> points(5);
  EXPECT_FALSE(resect(made_camera(100, 100, 60), points, {}));
}

TEST(ThinTracks, KeepsLongTracksAndCoversEveryImage) {
  Reconstruction images;
  images.lenses.push_back({.camera = made_camera(800, 800, 60)});
  for (int i = 0; i < 3; ++i) images.images.push_back({.name = "i"});
  std::vector<TiePoint> tracks;
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    TiePoint& t = tracks.emplace_back();
    for (std::size_t image = 0; image < (i % 10 == 0 ? 3u : 2u); ++image)
      t.marks.push_back({.image = image, .pixel = {random.uniform(0, 800), random.uniform(0, 800)}, .sd = 1});
  }
  const std::vector<std::size_t> chosen = thin_tracks(tracks, images, 256);
  std::size_t longest = 0;
  for (const std::size_t i : chosen) longest += tracks[i].marks.size() == 3;
  EXPECT_GE(longest, 200u);
  EXPECT_GE(chosen.size(), 256u);
  EXPECT_LE(chosen.size(), 800u);
}

}  // namespace
}  // namespace waymark::test
