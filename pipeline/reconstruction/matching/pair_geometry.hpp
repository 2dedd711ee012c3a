// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>
#include "pipeline/reconstruction/matching/match_features.hpp"
#include "pipeline/reconstruction/matching/relative_pose.hpp"
namespace waymark::pipeline {

/// How two images are related, which decides what they can give.
enum class PairKind {
  none,      ///< too few matches agree
  general,   ///< relief and motion across the view
  planar,    ///< a homography explains the matches: the motion may be ambiguous
  rotation,  ///< no parallax: a turn on the spot, or a far scene
  forward,   ///< motion along the view, as in a vertical descent
};

struct PairGeometry {
  PairKind kind = PairKind::none;
  std::vector<Match> inliers = {};
  std::vector<RelativePose> poses = {};  ///< best first; more than one where a plane leaves two
  std::array<double, 3> angles{};        ///< percentiles 10, 50, 90 of the angle between rays, radians
  std::size_t homography_inliers = 0;    ///< of all matches
};

struct PairSettings {
  double threshold = 2e-3;  ///< largest angle between a ray and its epipolar plane, radians
  std::size_t min_inliers = 16;
  std::uint64_t seed = 1;
};

/// Estimates the motion between two images from matched rays (unit vectors in the camera frames).
/// - Essential matrix and homography are both estimated (MAGSAC, Barath 2020), decomposed and refined; the
///   pose that most matches agree with wins.
/// - Matches agree if their ray lies in the epipolar plane and their point before both cameras.
/// - `rotation`: a rotation explains 80 % as many matches as the pose; `planar`: a homography does;
///   `forward`: within 18 degrees of both optical axes.
PairGeometry pair_geometry(std::span<const Match> matches, std::span<const Eigen::Vector3d> first,
                           std::span<const Eigen::Vector3d> second, const PairSettings& settings);

/// Fundamental matrix of matched pixels about the middle of each image, and the matches that agree.
struct FundamentalGeometry {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();  ///< second^T matrix first = 0
  std::vector<Match> inliers = {};
  bool planar = false;  ///< a homography explains 80 % as many matches: the matrix is not unique
};

/// Estimates the fundamental matrix, for images of unknown focal length. `threshold` in pixels.
FundamentalGeometry fundamental_geometry(std::span<const Match> matches,
                                         std::span<const Eigen::Vector2d> first,
                                         std::span<const Eigen::Vector2d> second, double threshold,
                                         std::uint64_t seed);

}  // namespace waymark::pipeline
