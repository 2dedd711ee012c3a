// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/pair_geometry.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <numbers>

#include "core/random.hpp"
#include "pipeline/reconstruction/matching/focal_vote.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr double kFocal = 1000;  // pixels: noise of 0.5 px is 0.5e-3 rad

struct RayScene {
  double relief = 0.3;  // of the distance
  Eigen::Vector3d motion = {0.2, 0, 0};
  Eigen::Vector3d turn = {0.02, -0.03, 0.3};
  int points = 300, outliers = 100;
  double noise = 0.5;  // pixels
};

struct RayMatches {
  std::vector<Eigen::Vector3d> first, second;
  std::vector<Match> matches;
  RelativePose truth;
};

RayMatches make_rays(const RayScene& scene, std::uint64_t seed) {
  Random random(seed);
  RayMatches out;
  out.truth.rotation = Eigen::AngleAxisd(scene.turn.norm(), scene.turn.normalized()).toRotationMatrix();
  out.truth.direction = scene.motion.norm() > 0 ? scene.motion.normalized() : Eigen::Vector3d::Zero();
  const auto noisy = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector2d pixel =
        kFocal * p.hnormalized() + scene.noise * Eigen::Vector2d(random.normal(), random.normal());
    return Eigen::Vector3d(pixel.x() / kFocal, pixel.y() / kFocal, 1).normalized();
  };
  for (int i = 0; i < scene.points + scene.outliers; ++i) {
    const Eigen::Vector3d p = Eigen::Vector3d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1) *
                              (1 + scene.relief * random.uniform(-0.5, 0.5));
    Eigen::Vector3d q = out.truth.rotation * p + scene.motion;
    if (i >= scene.points) q = Eigen::Vector3d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1);
    out.first.push_back(noisy(p));
    out.second.push_back(noisy(q));
    out.matches.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i)});
  }
  return out;
}

PairGeometry geometry_of(const RayMatches& rays) {
  return pair_geometry(rays.matches, rays.first, rays.second, {.threshold = 2 / kFocal});
}

double rotation_error(const RelativePose& a, const RelativePose& b) {
  return Eigen::AngleAxisd(a.rotation * b.rotation.transpose()).angle() / kDegree;
}
double direction_error(const RelativePose& a, const RelativePose& b) {
  return std::acos(std::clamp(a.direction.dot(b.direction), -1.0, 1.0)) / kDegree;
}

TEST(PairGeometry, FindsAGeneralMotion) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RayMatches rays = make_rays({}, seed);
    const PairGeometry found = geometry_of(rays);
    ASSERT_EQ(found.kind, PairKind::general) << "seed " << seed;
    EXPECT_LT(rotation_error(found.poses[0], rays.truth), 0.2);
    EXPECT_LT(direction_error(found.poses[0], rays.truth), 2);
    EXPECT_GE(found.inliers.size(), 280u);
    EXPECT_LE(found.inliers.size(), 320u);  // outliers may fall on their epipolar line
    EXPECT_NEAR(found.angles[1], 0.2, 0.05);
  }
}

TEST(PairGeometry, APlaneGivesAPoseThatMayBeOneOfTwo) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RayMatches rays = make_rays({.relief = 0, .motion = {0.2, 0.05, 0.1}}, seed);
    const PairGeometry found = geometry_of(rays);
    ASSERT_EQ(found.kind, PairKind::planar) << "seed " << seed;
    double best = 180;
    for (const RelativePose& pose : found.poses)
      best = std::min(best, rotation_error(pose, rays.truth) + direction_error(pose, rays.truth));
    EXPECT_LT(best, 6) << "seed " << seed;
  }
}

TEST(PairGeometry, ATurnOnTheSpotIsARotation) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RayMatches rays = make_rays({.motion = {0, 0, 0}, .turn = {0.1, 0.05, 0.2}}, seed);
    const PairGeometry found = geometry_of(rays);
    ASSERT_EQ(found.kind, PairKind::rotation) << "seed " << seed;
    EXPECT_LT(rotation_error(found.poses[0], rays.truth), 0.1);
  }
}

TEST(PairGeometry, ADescentIsForward) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RayMatches rays = make_rays({.motion = {0.01, 0, -0.4}, .turn = {0, 0, 0.1}}, seed);
    const PairGeometry found = geometry_of(rays);
    ASSERT_EQ(found.kind, PairKind::forward) << "seed " << seed;
    EXPECT_LT(rotation_error(found.poses[0], rays.truth), 0.3);
    EXPECT_LT(direction_error(found.poses[0], rays.truth), 2);
  }
}

TEST(PairGeometry, NoiseAloneIsNoGeometry) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RayMatches rays = make_rays({.points = 0, .outliers = 60}, seed);
    EXPECT_EQ(geometry_of(rays).kind, PairKind::none) << "seed " << seed;
  }
}

TEST(PairGeometry, TheSameSeedGivesTheSameBits) {
  const RayMatches rays = make_rays({}, 3);
  const PairGeometry a = geometry_of(rays), b = geometry_of(rays);
  EXPECT_EQ(a.poses[0].rotation, b.poses[0].rotation);
  EXPECT_EQ(a.inliers, b.inliers);
}

// Axes that meet in a point would leave the focal length open.
TEST(FocalVote, TurnedViewsGiveTheFocalLength) {
  std::vector<FocalEvidence> votes;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Eigen::Vector3d turn(0.1 + 0.05 * double(seed), -0.1, 0.3);
    const RayMatches rays = make_rays({.motion = {0.3, 0.1 * double(seed) - 0.3, 0.1}, .turn = turn}, seed);
    std::vector<Eigen::Vector2d> a, b;
    for (const Eigen::Vector3d& r : rays.first) a.emplace_back(kFocal * r.hnormalized());
    for (const Eigen::Vector3d& r : rays.second) b.emplace_back(kFocal * r.hnormalized());
    const FundamentalGeometry found = fundamental_geometry(rays.matches, a, b, 2, 1);
    EXPECT_GE(found.inliers.size(), 270u);
    EXPECT_FALSE(found.planar);
    votes.push_back({found.matrix, double(found.inliers.size())});
  }
  const auto focal = vote_focal_length(votes, 300, 5000);
  ASSERT_TRUE(focal);
  EXPECT_NEAR(*focal, kFocal, 50);
}

TEST(FocalVote, ParallelAxesGiveNone) {
  std::vector<FocalEvidence> votes;
  for (int i = 0; i < 5; ++i) {
    Eigen::Matrix3d f;  // pure translation: [t]x is essential for every focal length
    f << 0, 0, 0.1 * i, 0, 0, -1, -0.1 * i, 1, 0;
    votes.push_back({f, 100});
  }
  EXPECT_FALSE(vote_focal_length(votes, 300, 5000));
}

}  // namespace
}  // namespace waymark::test
