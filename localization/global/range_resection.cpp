// SPDX-License-Identifier: Apache-2.0
#include "localization/global/range_resection.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <set>

namespace waymark::localization {
namespace {

constexpr std::size_t kMinRanges = 8, kMinLandmarks = 2;
constexpr int kHeadings = 36, kIterations = 15;
constexpr double kInlier = 9;     // squared standard deviations of a range
constexpr double kMaxTest = 3.5;  // standard deviations of a range given all others
constexpr double kWorst = 0.7;    // of the largest one, removed together
constexpr int kRounds = 4;
constexpr double kMinInliers = 0.6;                  // fraction of the ranges
constexpr double kLead = 25;                         // difference of chi2 to the next pose
constexpr double kMaxFit = 3;                        // chi2 per degree of freedom
constexpr double kMaxSd = 2;                         // m
constexpr double kMaxYawSd = 0.2;                    // rad
constexpr double kSamePosition = 1, kSameYaw = 0.3;  // m, rad: nearer minima are one pose
constexpr double kRival = 0.8;                       // fraction of the best one's inliers

struct Row {
  Eigen::Vector2d from, landmark;
  double range, variance;  // m^2, of sensor, map and odometry together
  const EarlierRange* seen;
  const MapLandmark* known;
};

struct Minimum {
  Pose2 pose;
  double cost = 0;
  std::vector<std::size_t> inliers;
};

struct Fit {
  PoseEstimate at;
  double chi2 = 0;
  Eigen::VectorXd tests = {};  // of each range, in standard deviations given all others (w-test, Baarda 1968)
};

using RowDerivative = Eigen::RowVector3d;

/// Displacement of a place by an error of displacement and turn about the origin.
Eigen::Matrix<double, 2, 3> lever(const Eigen::Vector2d& at) {
  Eigen::Matrix<double, 2, 3> f;
  f << 1, 0, -at.y(), 0, 1, at.x();
  return f;
}

struct Residual {
  double value;             // measured less expected, m
  Eigen::Vector2d towards;  // unit vector from landmark to sensor
  RowDerivative by_pose;    // of the expected range
};

Residual residual_of(const Row& row, const Pose2& pose) {
  const Eigen::Vector2d turned = Eigen::Rotation2Dd(pose.yaw) * row.from;
  const Eigen::Vector2d d = pose.at() + turned - row.landmark;
  const double range = std::max(d.norm(), 1e-3);
  const Eigen::Vector2d n = d / range;
  return {row.range - range, n, n.transpose() * lever(turned)};
}

/// Returns the local minimum from a start, by Gauss-Newton with the weights of a Cauchy kernel.
Minimum descend(std::span<const Row> rows, Pose2 pose) {
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() * 1e-9;
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Row& row : rows) {
      const Residual r = residual_of(row, pose);
      const double weight = 1 / (row.variance + r.value * r.value / 4);
      normal += weight * r.by_pose.transpose() * r.by_pose;
      right += weight * r.value * r.by_pose.transpose();
    }
    const Eigen::Vector3d step = normal.ldlt().solve(right);
    if (!step.allFinite()) break;
    pose = pose_of(pose.vector() + step);
    if (step.norm() < 1e-6) break;
  }
  Minimum minimum{.pose = pose, .inliers = {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Residual r = residual_of(rows[i], pose);
    const double squares = r.value * r.value / rows[i].variance;
    minimum.cost += std::min(squares, kInlier);
    if (squares < kInlier) minimum.inliers.push_back(i);
  }
  return minimum;
}

/// Returns positions that fit the ranges for a heading: linear along the longer axis of the landmarks as seen
/// by a robot that did not move, on both sides of it.
std::vector<Pose2> starts(std::span<const Row> rows, double yaw) {
  const double count = static_cast<double>(rows.size());
  std::vector<Eigen::Vector2d> centres;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Row& row : rows) {
    centres.push_back(row.landmark - Eigen::Rotation2Dd(yaw) * row.from);
    mean += centres.back() / count;
  }
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& c : centres) spread += (c - mean) * (c - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);  // ascending
  const Eigen::Matrix2d back = axes.eigenvectors().transpose();
  if (!(axes.eigenvalues()[1] > 1e-6 * count)) return {};
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector2d c = back * (centres[i] - mean);
    moment += c * (c.squaredNorm() - rows[i].range * rows[i].range);
  }
  const double along = moment[1] / (2 * axes.eigenvalues()[1]);
  double square = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector2d c = back * (centres[i] - mean);
    square += (rows[i].range * rows[i].range - (along - c[1]) * (along - c[1]) - c[0] * c[0]) / count;
  }
  std::vector<double> across{std::sqrt(std::max(0.0, square)), -std::sqrt(std::max(0.0, square))};
  if (axes.eigenvalues()[0] > 1e-3 * axes.eigenvalues()[1])
    across.push_back(moment[0] / (2 * axes.eigenvalues()[0]));
  std::vector<Pose2> poses;
  for (const double side : across) {
    const Eigen::Vector2d at = mean + back.transpose() * Eigen::Vector2d(side, along);
    poses.push_back({at.x(), at.y(), yaw});
  }
  return poses;
}

bool is_same(const Pose2& a, const Pose2& b) {
  return (a.at() - b.at()).norm() < kSamePosition && std::abs(wrap_angle(a.yaw - b.yaw)) < kSameYaw;
}

std::vector<Minimum> minima(std::span<const Row> rows) {
  std::vector<Minimum> all;
  for (int i = 0; i < kHeadings; ++i)
    for (const Pose2& start : starts(rows, 2 * std::numbers::pi * i / kHeadings - std::numbers::pi)) {
      Minimum found = descend(rows, start);
      const auto same =
          std::ranges::find_if(all, [&](const Minimum& m) { return is_same(m.pose, found.pose); });
      if (same == all.end())
        all.push_back(std::move(found));
      else if (found.cost < same->cost)
        *same = std::move(found);
    }
  std::ranges::stable_sort(all, {}, &Minimum::cost);
  return all;
}

/// Returns the covariance of ranges seen from a pose.
Eigen::MatrixXd noise_of(std::span<const Row> rows, std::span<const Residual> residuals, const Pose2& pose) {
  const auto size = static_cast<Eigen::Index>(rows.size());
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(pose.yaw).toRotationMatrix();
  std::vector<RowDerivative> by_motion;
  for (std::size_t i = 0; i < rows.size(); ++i)
    by_motion.push_back(residuals[i].towards.transpose() * turn * lever(rows[i].from));
  Eigen::MatrixXd noise(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = i; j < size; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);  // b is the later one
      double common = by_motion[a] * rows[b].seen->motion * by_motion[b].transpose();
      if (rows[a].known == rows[b].known)
        common += residuals[a].towards.dot(rows[a].known->covariance * residuals[b].towards);
      if (a == b) common += rows[a].seen->sd * rows[a].seen->sd;
      noise(i, j) = noise(j, i) = common;
    }
  return noise;
}

/// Returns the pose that fits the chosen ranges best, with all correlations of their errors.
Fit refine(std::span<const Row> all, std::span<const std::size_t> chosen, const Pose2& start) {
  std::vector<Row> rows;
  for (const std::size_t i : chosen) rows.push_back(all[i]);
  Fit fit{.at = {start, Eigen::Matrix3d::Identity() * 1e12}, .chi2 = 1e12};
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Residual> residuals;
    Eigen::VectorXd values(rows.size());
    Eigen::MatrixX3d by_pose(rows.size(), 3);
    for (const Row& row : rows) {
      const auto i = static_cast<Eigen::Index>(residuals.size());
      residuals.push_back(residual_of(row, fit.at.pose));
      values[i] = residuals.back().value, by_pose.row(i) = residuals.back().by_pose;
    }
    const Eigen::LLT<Eigen::MatrixXd> noise(noise_of(rows, residuals, fit.at.pose));
    if (noise.info() != Eigen::Success) return fit;
    const Eigen::MatrixX3d weighted = noise.solve(by_pose);
    const Eigen::Matrix3d normal = by_pose.transpose() * weighted;
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
    const Eigen::Vector3d step = solver.solve(weighted.transpose() * values);
    const Eigen::Matrix3d covariance = solver.solve(Eigen::Matrix3d::Identity());
    if (!step.allFinite() || !covariance.allFinite()) return fit;
    fit.at = {pose_of(fit.at.pose.vector() + step), (covariance + covariance.transpose()) / 2};
    const Eigen::VectorXd left = values - by_pose * step;
    const Eigen::VectorXd whitened = noise.solve(left);
    fit.chi2 = left.dot(whitened);
    if (round + 1 < kRounds) continue;
    const Eigen::MatrixXd inverse = noise.solve(Eigen::MatrixXd::Identity(left.size(), left.size()));
    fit.tests = whitened.cwiseQuotient(inverse.diagonal().cwiseSqrt());
  }
  return fit;
}

/// Refines a minimum and removes what does not fit the other ranges, the worst first: an echo may lie within
/// the error of odometry, but not beside its neighbours.
Fit refine_robustly(std::span<const Row> rows, Minimum& minimum) {
  Fit fit = refine(rows, minimum.inliers, minimum.pose);
  while (minimum.inliers.size() > kMinRanges && fit.tests.size() > 0) {
    const Eigen::VectorXd tests = fit.tests.cwiseAbs();
    const double limit = std::max(kMaxTest, kWorst * tests.maxCoeff());
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < minimum.inliers.size(); ++i)
      if (tests[static_cast<Eigen::Index>(i)] < limit) kept.push_back(minimum.inliers[i]);
    if (kept.size() == minimum.inliers.size()) break;
    minimum.inliers = std::move(kept);
    fit = refine(rows, minimum.inliers, fit.at.pose);
  }
  return fit;
}

std::vector<Row> rows_of(std::span<const EarlierRange> ranges, const LandmarkGrid& map) {
  std::vector<Row> rows;
  for (const EarlierRange& r : ranges) {
    const auto known = map.find(r.landmark);
    if (!known) continue;
    const MapLandmark& l = map[*known];
    const Eigen::Matrix<double, 2, 3> f = lever(r.from);
    const double variance = r.sd * r.sd + (l.covariance.trace() + (f * r.motion * f.transpose()).trace()) / 2;
    rows.push_back({r.from, l.at, r.range, variance, &r, &l});
  }
  return rows;
}

}  // namespace

PoseSearchResult resect(std::span<const EarlierRange> ranges, const LandmarkGrid& map) {
  PoseSearchResult result;
  const std::vector<Row> rows = rows_of(ranges, map);
  std::set<const MapLandmark*> landmarks;
  for (const Row& row : rows) landmarks.insert(row.known);
  result.reason = "too few ranges to landmarks of the map";
  if (rows.size() < kMinRanges || landmarks.size() < kMinLandmarks) return result;

  std::vector<Minimum> found = minima(rows);
  result.reason = "no pose explains most of the ranges";
  if (found.empty()) return result;
  Minimum& best = found[0];
  const Fit fit = refine_robustly(rows, best);
  const double needed = kMinInliers * static_cast<double>(rows.size());
  if (!(static_cast<double>(best.inliers.size()) >= needed) || best.inliers.size() < kMinRanges)
    return result;
  const double per_freedom = fit.chi2 / static_cast<double>(best.inliers.size() - 3);
  if (!(per_freedom < kMaxFit)) return result;
  const PoseEstimate at{fit.at.pose, fit.at.covariance * std::max(1.0, per_freedom)};
  result.candidates.push_back(at);

  bool has_rival = false;
  for (std::size_t i = 1; i < found.size(); ++i) {
    Minimum& rival = found[i];
    const double enough = kRival * static_cast<double>(best.inliers.size());
    if (static_cast<double>(rival.inliers.size()) < enough) continue;
    const Fit other = refine(rows, best.inliers, rival.pose), own = refine_robustly(rows, rival);
    if (is_same(other.at.pose, at.pose) || is_same(own.at.pose, at.pose)) continue;
    if (static_cast<double>(rival.inliers.size()) < enough) continue;
    if (other.chi2 - fit.chi2 > kLead && refine(rows, rival.inliers, best.pose).chi2 - own.chi2 > -kLead)
      continue;
    has_rival = true;
    result.candidates.push_back(other.at);
  }
  const double sd = std::sqrt(at.covariance(0, 0) + at.covariance(1, 1));
  result.reason =
      has_rival ? "another pose explains the ranges as well" : "the ranges leave the pose uncertain";
  if (has_rival || !(sd < kMaxSd) || !(std::sqrt(at.covariance(2, 2)) < kMaxYawSd)) return result;
  result.accepted = at;
  result.reason = {};
  return result;
}

}  // namespace waymark::localization
