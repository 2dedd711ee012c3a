// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/map_errors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "localization/body_motion.hpp"
#include "localization/filters/measurement.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kMaxLandmarks = 100;  // the least recently seen one is forgotten
constexpr double kMaxExplained = 0.98;      // of a variance, by what it is correlated with

/// A sighting as a linear function of pose and landmark, with the noise of what is not linear.
struct LinearSighting {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_landmark;
  Eigen::Matrix2d residual = Eigen::Matrix2d::Zero();
};

LinearSighting by_derivatives(const PoseEstimate& at, const Pose2& mount, const SeenLandmark& of,
                              const MapLandmark& landmark) {
  const ExpectedSighting e = expect(at.pose, mount, of, landmark);
  return {e.value, e.by_pose, e.by_landmark};
}

// Statistical linear regression over the symmetric points of three dimensions.
LinearSighting by_regression(const PoseEstimate& at, const Pose2& mount, const SeenLandmark& of,
                             const MapLandmark& landmark) {
  constexpr int kPoints = 6;
  LinearSighting line = by_derivatives(at, mount, of, landmark);
  const Eigen::Matrix3d root = square_root(at.covariance);
  if (!(root.diagonal().minCoeff() > 0)) return line;
  Eigen::Matrix<double, 2, kPoints> seen;
  for (int i = 0; i < kPoints; ++i) {
    const double reach = std::sqrt(3.0) * (i % 2 ? -1 : 1);
    seen.col(i) = expect(pose_of(at.pose.vector() + reach * root.col(i / 2)), mount, of, landmark).value;
    seen(1, i) = wrap_angle(seen(1, i) - line.value[1]);  // about the bearing in the middle
  }
  const Eigen::Vector2d mean = seen.rowwise().mean();
  seen.colwise() -= mean;
  Eigen::Matrix<double, 2, 3> by_root;
  for (int k = 0; k < 3; ++k) by_root.col(k) = (seen.col(2 * k) - seen.col(2 * k + 1)) / (2 * std::sqrt(3.0));
  line.value = {mean[0], wrap_angle(line.value[1] + mean[1])};
  line.by_pose = by_root * root.inverse();
  line.residual = seen * seen.transpose() / kPoints - by_root * by_root.transpose();
  return line;
}

/// Returns the covariance of a landmark's position; of a sighted line with what its direction adds.
Eigen::Matrix2d error_of(const SeenLandmark& seen, const MapLandmark& landmark,
                         const Eigen::Vector2d& sensor) {
  if (!seen.extent || !landmark.is_line()) return landmark.covariance;
  return landmark.covariance +
         swing_variance(landmark, sensor) * landmark.normal * landmark.normal.transpose();
}

/// Returns the covariance of pose and landmark, scaled down to what their own covariances allow: what was
/// forgotten, mixed or undone by a motion may leave more, and an update would then make variances negative.
Eigen::Matrix<double, 3, 2> limit_correlation(const Eigen::Matrix<double, 3, 2>& with,
                                              const Eigen::Matrix3d& pose, const Eigen::Matrix2d& landmark) {
  const Eigen::Matrix2d explained = landmark.inverse() * with.transpose() * pose.inverse() * with;
  const double mean = explained.trace() / 2;
  const double largest = mean + std::sqrt(std::max(0.0, mean * mean - explained.determinant()));
  return largest > kMaxExplained ? Eigen::Matrix<double, 3, 2>(with * std::sqrt(kMaxExplained / largest))
                                 : with;
}

}  // namespace

void MapErrors::predict(const Pose2& before, const Pose2& step) {
  driven_ += step.at().norm();
  is_limited_ = false;
  if (errors_.empty()) return;
  const Eigen::Matrix3d by_pose = motion_jacobians(before, step).by_pose;
  for (Entry& e : errors_) e.covariance = by_pose * e.covariance;
}

void MapErrors::follow(const PoseEstimate& before, const PoseEstimate& after) {
  is_limited_ = false;
  if (errors_.empty()) return;
  const Eigen::Matrix3d change =
      after.covariance * (before.covariance + 1e-12 * Eigen::Matrix3d::Identity()).inverse();
  if (!change.allFinite()) return clear();
  for (Entry& e : errors_) e.covariance = change * e.covariance;
}

// Errors of different landmarks are independent: together they explain no more of the pose than all of it.
// What was forgotten or mixed, or a line that swings about another point, may leave more; the pose would then
// become certain by its own errors.
void MapErrors::limit_jointly(const Eigen::Matrix3d& pose) {
  if (is_limited_) return;
  is_limited_ = true;
  Eigen::Matrix3d explained = Eigen::Matrix3d::Zero();
  for (const Entry& e : errors_) explained += e.covariance * e.information * e.covariance.transpose();
  const Eigen::LLT<Eigen::Matrix3d> root(pose);
  if (root.info() != Eigen::Success) return clear();
  const Eigen::Matrix3d half = root.matrixL().solve(explained);
  const Eigen::Matrix3d fraction = root.matrixL().solve(half.transpose());
  const double largest =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(fraction, Eigen::EigenvaluesOnly).eigenvalues()[2];
  if (!(largest > kMaxExplained)) return;
  for (Entry& e : errors_) e.covariance *= std::sqrt(kMaxExplained / largest);
}

/// A sighting with all that a correction needs; rows that it lacks are zero.
struct MapErrors::Linear {
  LandmarkKey key;
  Eigen::Vector2d innovation;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_landmark, map_error, noise;
  WithLandmark with_landmark;  // covariance of the pose and the landmark's error
};

MapErrors::Linear MapErrors::linear_sighting(const PoseEstimate& before, const SeenLandmark& measured,
                                             const Pose2& robot_from_sensor, const MapLandmark& landmark,
                                             double trust, bool unscented) const {
  std::optional<SeenLandmark> corrected;
  if (!measured.bearing && !unscented)
    corrected = correct_curvature(measured, before, robot_from_sensor, landmark.at);
  const SeenLandmark& seen = corrected ? *corrected : measured;
  const LinearSighting line = unscented ? by_regression(before, robot_from_sensor, seen, landmark)
                                        : by_derivatives(before, robot_from_sensor, seen, landmark);
  const auto at = std::ranges::lower_bound(errors_, landmark.key, {}, &Entry::key);
  const bool known = at != errors_.end() && at->key == landmark.key;
  Linear all{.key = landmark.key,
             .innovation = innovation(seen, line.value),
             .by_pose = line.by_pose,
             .by_landmark = line.by_landmark,
             .map_error = error_of(seen, landmark, (before.pose * robot_from_sensor).at()) / trust,
             .noise = sensor_noise(seen) / trust + line.residual,
             .with_landmark = WithLandmark::Zero()};
  if (known) all.with_landmark = limit_correlation(at->covariance, before.covariance, all.map_error);
  omit_missing(seen, all.by_pose, all.by_landmark, all.noise);
  return all;
}

// Joseph form, which holds for any gain; the landmark's error is not corrected.
Eigen::Matrix3d MapErrors::apply(const Linear& line, const WithLandmark& gain, const Eigen::Matrix3d& p) {
  const Eigen::Matrix2d& b = line.by_landmark;
  const Eigen::Matrix3d a = Eigen::Matrix3d::Identity() - gain * line.by_pose;
  const WithLandmark with_map = line.with_landmark * b.transpose();
  const Eigen::Matrix3d cross = a * with_map * gain.transpose();
  const Eigen::Matrix3d after = a * p * a.transpose() - cross - cross.transpose() +
                                gain * (b * line.map_error * b.transpose() + line.noise) * gain.transpose();
  for (Entry& e : errors_) e.covariance = a * e.covariance;
  if (memory_ > 0) {
    const WithLandmark now = a * line.with_landmark - gain * b * line.map_error;
    const Entry entry{line.key, now, driven_, line.map_error.inverse()};
    const auto at = std::ranges::lower_bound(errors_, line.key, {}, &Entry::key);
    if (at != errors_.end() && at->key == line.key)
      *at = entry;
    else
      errors_.insert(at, entry);
    drop_old();
  }
  return (after + after.transpose()) / 2;
}

PoseEstimate MapErrors::correct(const PoseEstimate& before, const SeenLandmark& seen,
                                const Pose2& robot_from_sensor, const MapLandmark& landmark, double trust,
                                bool unscented) {
  limit_jointly(before.covariance);
  const Linear line = linear_sighting(before, seen, robot_from_sensor, landmark, trust, unscented);
  const Eigen::Matrix<double, 2, 3>& h = line.by_pose;
  const Eigen::Matrix2d& b = line.by_landmark;
  const WithLandmark with_map = line.with_landmark * b.transpose();
  const WithLandmark with_seen = before.covariance * h.transpose() + with_map;
  const Eigen::Matrix2d s =
      h * with_seen + with_map.transpose() * h.transpose() + b * line.map_error * b.transpose() + line.noise;
  const WithLandmark gain = with_seen * s.inverse();
  const Eigen::Matrix3d after = apply(line, gain, before.covariance);
  return {pose_of(before.pose.vector() + gain * line.innovation), after};
}

MapErrors::Covariances MapErrors::follow(const Pose2& pose, const Covariances& before,
                                         const SeenLandmark& seen, const Pose2& robot_from_sensor,
                                         const MapLandmark& landmark, double factor) {
  limit_jointly(before.real);
  const Linear line = linear_sighting({pose, before.real}, seen, robot_from_sensor, landmark, 1, false);
  const Eigen::Matrix2d& b = line.by_landmark;
  const WithLandmark with_seen = before.assumed * line.by_pose.transpose();
  const WithLandmark gain =
      with_seen *
      (line.by_pose * with_seen + factor * b * line.map_error * b.transpose() + line.noise).inverse();
  const Eigen::Matrix3d assumed = before.assumed - gain * with_seen.transpose();
  return {.real = apply(line, gain, before.real), .assumed = (assumed + assumed.transpose()) / 2};
}

PoseEstimate MapErrors::correct_probably(const PoseEstimate& before, const SeenLandmark& seen,
                                         const Pose2& robot_from_sensor, const MapLandmark& landmark,
                                         double trust, double probability, bool unscented) {
  if (!(probability < 1)) return correct(before, seen, robot_from_sensor, landmark, trust, unscented);
  const MapErrors without = *this;
  const PoseEstimate after = correct(before, seen, robot_from_sensor, landmark, trust, unscented);
  mix(without, 1 - probability);
  const Eigen::Vector3d back(before.pose.x - after.pose.x, before.pose.y - after.pose.y,
                             wrap_angle(before.pose.yaw - after.pose.yaw));
  return {pose_of(after.pose.vector() + (1 - probability) * back),
          probability * after.covariance + (1 - probability) * before.covariance +
              probability * (1 - probability) * back * back.transpose()};
}

void MapErrors::mix(const MapErrors& other, double other_weight) {
  std::vector<Entry> mixed;
  auto i = errors_.begin();
  auto j = other.errors_.begin();
  while (i != errors_.end() || j != other.errors_.end()) {
    const bool mine = i != errors_.end() && (j == other.errors_.end() || i->key <= j->key);
    const bool theirs = j != other.errors_.end() && (i == errors_.end() || j->key <= i->key);
    Entry e = mine ? *i : *j;
    e.covariance.setZero();
    if (mine) e.covariance += (1 - other_weight) * i->covariance, e.driven = std::max(e.driven, i++->driven);
    if (theirs) e.covariance += other_weight * j->covariance, e.driven = std::max(e.driven, j++->driven);
    mixed.push_back(e);
  }
  errors_ = std::move(mixed);
}

void MapErrors::drop_old() {
  std::erase_if(errors_, [&](const Entry& e) { return driven_ - e.driven > memory_; });
  if (errors_.size() > kMaxLandmarks) errors_.erase(std::ranges::min_element(errors_, {}, &Entry::driven));
}

}  // namespace waymark::localization
