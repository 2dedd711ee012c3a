// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/pair_geometry.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <optional>

#include "core/solve.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kUnits = 1000;  // OpenCV's thresholds are made for pixels: image planes are 1000 units away
constexpr double kExplains = 0.8;    // COLMAP's limit for planar and panoramic pairs
constexpr double kForward = 0.95;    // cosine
constexpr double kMinForward = 0.2;  // rays closer to the image plane than 78 degrees from the axis

std::vector<RayPair> ray_pairs(std::span<const Match> matches, std::span<const Eigen::Vector3d> first,
                               std::span<const Eigen::Vector3d> second) {
  std::vector<RayPair> pairs;
  pairs.reserve(matches.size());
  for (const Match& m : matches) pairs.push_back({first[m.first], second[m.second]});
  return pairs;
}

cv::UsacParams magsac(double threshold, std::uint64_t seed) {
  cv::UsacParams params;
  params.confidence = 0.9999;
  params.isParallel = false;
  params.maxIterations = 5000;
  params.randomGeneratorState = static_cast<int>(seed & 0x7fffffffU);
  params.sampler = cv::SAMPLING_UNIFORM;
  params.score = cv::SCORE_METHOD_MAGSAC;
  params.loMethod = cv::LOCAL_OPTIM_SIGMA;
  params.threshold = threshold;
  return params;
}

Eigen::Matrix3d eigen_of(const cv::Mat& m) {
  Eigen::Matrix3d out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out(r, c) = m.at<double>(r, c);
  return out;
}

bool is_matrix(const cv::Mat& m) {
  return m.rows == 3 && m.cols == 3 && m.type() == CV_64F && cv::checkRange(m);
}

// OpenCV reports degenerate samples by exceptions or by empty matrices.
template <class Estimate>
std::optional<cv::Mat> attempt(const Estimate& estimate) {
  try {
    cv::Mat made = estimate();
    if (is_matrix(made)) return made;
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  return std::nullopt;
}

// Points on image planes; matches near or beyond the plane through the centre are left out.
struct PlanePoints {
  std::vector<cv::Point2d> first, second;
};

PlanePoints plane_points(const std::vector<RayPair>& pairs) {
  PlanePoints out;
  for (const RayPair& rays : pairs) {
    if (!(rays.first.z() > kMinForward) || !(rays.second.z() > kMinForward)) continue;
    out.first.emplace_back(kUnits * rays.first.x() / rays.first.z(),
                           kUnits * rays.first.y() / rays.first.z());
    out.second.emplace_back(kUnits * rays.second.x() / rays.second.z(),
                            kUnits * rays.second.y() / rays.second.z());
  }
  return out;
}

void add_essential_poses(const PlanePoints& points, const PairSettings& settings,
                         std::vector<RelativePose>& poses) {
  const cv::Mat camera = (cv::Mat_<double>(3, 3) << kUnits, 0, 0, 0, kUnits, 0, 0, 0, 1);
  const auto essential = attempt([&] {
    cv::Mat mask;
    return cv::findEssentialMat(points.first, points.second, camera, camera, cv::noArray(), cv::noArray(),
                                mask, magsac(kUnits * settings.threshold, settings.seed));
  });
  if (!essential) return;
  cv::Mat one, two, t;
  cv::decomposeEssentialMat(*essential, one, two, t);
  const Eigen::Vector3d direction(t.at<double>(0), t.at<double>(1), t.at<double>(2));
  for (const cv::Mat& rotation : {one, two})
    for (const double sign : {1.0, -1.0})
      poses.push_back({eigen_of(rotation), sign * direction.normalized()});
}

std::optional<Eigen::Matrix3d> homography_of(const PlanePoints& points, const PairSettings& settings) {
  const auto found = attempt([&] {
    cv::Mat mask;
    return cv::findHomography(points.first, points.second, mask,
                              magsac(kUnits * settings.threshold, settings.seed));
  });
  if (!found) return std::nullopt;
  const Eigen::DiagonalMatrix<double, 3> scale(kUnits, kUnits, 1);
  Eigen::Matrix3d h = scale.inverse() * eigen_of(*found) * scale;
  if (!(std::abs(h.determinant()) > 1e-12)) return std::nullopt;
  return h / std::cbrt(h.determinant());
}

std::size_t homography_inliers(const Eigen::Matrix3d& h, const std::vector<RayPair>& pairs,
                               double threshold) {
  return static_cast<std::size_t>(std::ranges::count_if(pairs, [&](const RayPair& rays) {
    return ((h * rays.first).normalized() - rays.second).norm() < 1.5 * threshold;
  }));
}

void add_plane_poses(const Eigen::Matrix3d& h, std::vector<RelativePose>& poses) {
  cv::Mat matrix(3, 3, CV_64F);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) matrix.at<double>(r, c) = h(r, c);
  std::vector<cv::Mat> rotations, shifts, normals;
  try {
    cv::decomposeHomographyMat(matrix, cv::Mat::eye(3, 3, CV_64F), rotations, shifts, normals);
  } catch (const cv::Exception&) {
    return;
  }
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const Eigen::Vector3d t(shifts[i].at<double>(0), shifts[i].at<double>(1), shifts[i].at<double>(2));
    if (t.norm() > 1e-9 && t.allFinite()) poses.push_back({eigen_of(rotations[i]), t.normalized()});
  }
}

bool are_alike(const RelativePose& a, const RelativePose& b) {
  constexpr double kDegree = std::numbers::pi / 180;
  return Eigen::AngleAxisd(a.rotation * b.rotation.transpose()).angle() < kDegree &&
         a.direction.dot(b.direction) > std::cos(5 * kDegree);
}

std::array<double, 3> angle_percentiles(const RelativePose& pose, const std::vector<RayPair>& pairs,
                                        const std::vector<std::size_t>& inliers) {
  std::vector<double> angles;
  for (const std::size_t i : inliers)
    angles.push_back(std::atan2((pose.rotation * pairs[i].first).cross(pairs[i].second).norm(),
                                (pose.rotation * pairs[i].first).dot(pairs[i].second)));
  std::ranges::sort(angles);
  const auto at = [&](double q) { return angles[static_cast<std::size_t>(q * double(angles.size() - 1))]; };
  return {at(0.1), at(0.5), at(0.9)};
}

bool is_forward(const RelativePose& pose) {
  return std::abs(pose.direction.z()) > kForward &&
         std::abs((pose.rotation.transpose() * pose.direction).z()) > kForward;
}

struct ScoredPose {
  RelativePose pose;
  PoseScore score;
};

// Refines the candidates worth it and returns them by falling score, without repetitions.
std::vector<ScoredPose> best_poses(const std::vector<RelativePose>& candidates,
                                   const std::vector<RayPair>& pairs, double threshold) {
  std::vector<ScoredPose> all;
  double best = 0;
  for (const RelativePose& pose : candidates) {
    all.push_back({pose, score_pose(pose, pairs, threshold)});
    best = std::max(best, all.back().score.score);
  }
  std::erase_if(all, [&](const ScoredPose& p) { return p.score.score < 0.5 * best; });
  for (ScoredPose& one : all) {
    one.pose = refine_pose(one.pose, pairs, threshold);
    one.score = score_pose(one.pose, pairs, threshold);
  }
  std::ranges::stable_sort(
      all, [](const ScoredPose& a, const ScoredPose& b) { return a.score.score > b.score.score; });
  std::vector<ScoredPose> kept;
  for (ScoredPose& one : all)
    if (kept.empty() ||
        (one.score.score > 0.9 * kept[0].score.score &&
         std::ranges::none_of(kept, [&](const ScoredPose& k) { return are_alike(k.pose, one.pose); })))
      kept.push_back(std::move(one));
  return kept;
}

}  // namespace

PairGeometry pair_geometry(std::span<const Match> matches, std::span<const Eigen::Vector3d> first,
                           std::span<const Eigen::Vector3d> second, const PairSettings& settings) {
  PairGeometry out;
  const std::vector<RayPair> pairs = ray_pairs(matches, first, second);
  const PlanePoints points = plane_points(pairs);
  if (points.first.size() < std::max<std::size_t>(8, settings.min_inliers)) return out;
  std::vector<RelativePose> candidates;
  add_essential_poses(points, settings, candidates);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (const auto h = homography_of(points, settings)) {
    out.homography_inliers = homography_inliers(*h, pairs, settings.threshold);
    add_plane_poses(*h, candidates);
    const SingularValues3 svd = singular_values(*h);
    turn = svd.u * svd.v.transpose();
    if (turn.determinant() < 0) turn.setIdentity();
  }
  const FittedRotation fitted = fit_rotation(pairs, settings.threshold, turn);
  const std::size_t turned = fitted.inliers;
  turn = fitted.rotation;
  const std::vector<ScoredPose> best = best_poses(candidates, pairs, settings.threshold);
  const std::size_t agree = best.empty() ? 0 : best[0].score.inliers.size();
  if (std::max(turned, agree) < settings.min_inliers) return out;
  if (double(turned) >= kExplains * double(agree)) {
    out.kind = PairKind::rotation;
    out.poses = {{turn, Eigen::Vector3d::Zero()}};
    std::vector<std::size_t> inliers;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if ((turn * pairs[i].first - pairs[i].second).norm() < settings.threshold) inliers.push_back(i);
    for (const std::size_t i : inliers) out.inliers.push_back(matches[i]);
    out.angles = angle_percentiles(out.poses[0], pairs, inliers);
    return out;
  }
  for (const ScoredPose& one : best) out.poses.push_back(one.pose);
  for (const std::size_t i : best[0].score.inliers) out.inliers.push_back(matches[i]);
  out.angles = angle_percentiles(best[0].pose, pairs, best[0].score.inliers);
  // The second solution of a plane seen from the side is a motion along the view.
  const bool forward = std::ranges::all_of(out.poses, is_forward);
  const bool planar = double(out.homography_inliers) >= kExplains * double(agree);
  out.kind = forward ? PairKind::forward : planar ? PairKind::planar : PairKind::general;
  return out;
}

FundamentalGeometry fundamental_geometry(std::span<const Match> matches,
                                         std::span<const Eigen::Vector2d> first,
                                         std::span<const Eigen::Vector2d> second, double threshold,
                                         std::uint64_t seed) {
  FundamentalGeometry out;
  if (matches.size() < 16) return out;
  std::vector<cv::Point2d> one, two;
  for (const Match& m : matches) {
    one.emplace_back(first[m.first].x(), first[m.first].y());
    two.emplace_back(second[m.second].x(), second[m.second].y());
  }
  cv::Mat mask, plane_mask;
  const auto found = attempt([&] { return cv::findFundamentalMat(one, two, mask, magsac(threshold, seed)); });
  if (!found) return out;
  out.matrix = eigen_of(*found);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Eigen::Vector3d a = first[matches[i].first].homogeneous(),
                          b = second[matches[i].second].homogeneous();
    const Eigen::Vector3d line = out.matrix * a, back = out.matrix.transpose() * b;
    const double slope = line.head<2>().squaredNorm() + back.head<2>().squaredNorm();
    if (slope > 0 && std::abs(b.dot(line)) < threshold * std::sqrt(slope)) out.inliers.push_back(matches[i]);
  }
  const auto plane =
      attempt([&] { return cv::findHomography(one, two, plane_mask, magsac(threshold, seed)); });
  std::size_t on_plane = 0;
  if (plane) {
    const Eigen::Matrix3d h = eigen_of(*plane);
    for (const Match& m : matches)
      if (((h * first[m.first].homogeneous()).hnormalized() - second[m.second]).norm() < 1.5 * threshold)
        ++on_plane;
  }
  out.planar = double(on_plane) >= kExplains * double(out.inliers.size());
  return out;
}

}  // namespace waymark::pipeline
