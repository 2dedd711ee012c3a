// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/range_slam.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace waymark::localization {
namespace {

constexpr double kRangeGate = 10.8, kFixGateSquares = 16;  // 99.9 % of chi-square, 1 dof
constexpr int kRing = 36;                                  // hypotheses of a new beacon
constexpr double kEchoes = 20;                             // m, over which echoes spread
constexpr double kPruned = 1e-6, kDecided = 0.9999;        // weights
constexpr double kSamePosition = 2;  // squared distance of two hypotheses that have become one
constexpr double kMaxOpenSd = 2;     // m, of a position that is certain

}  // namespace

void RangeSlamOptions::describe(OptionVisitor& option) {
  option("range_offset_sd", offset_sd,
         {.help = "Metres by which all ranges to one beacon may be off over the drive; 0: not at all",
          .min = 0,
          .max = 100});
  option("range_outliers", outliers,
         {.help = "Fraction of echoes among ranges to beacons whose position is not known yet",
          .min = 1e-6,
          .max = 0.9});
}

RangeSlam::RangeSlam(const PoseEstimate& start, std::vector<RangeBeacon> beacons, RangeSlamOptions options)
    : options_(options) {
  if (!start.pose.finite() || !start.covariance.allFinite())
    throw std::invalid_argument("the start of a filter must be finite");
  const auto size = static_cast<Eigen::Index>(3 + 3 * beacons.size());
  mean_ = Eigen::VectorXd::Zero(size);
  covariance_ = Eigen::MatrixXd::Zero(size, size);
  mean_.head<3>() = start.pose.vector();
  covariance_.topLeftCorner<3, 3>() = start.covariance;
  Eigen::Index row = 3;
  for (const RangeBeacon& b : beacons) {
    mean_.segment<2>(row) = b.at;
    covariance_.block<2, 2>(row, row) = b.covariance;
    covariance_(row + 2, row + 2) = options_.offset_sd * options_.offset_sd;
    beacons_.push_back({.key = b.key, .height = b.height, .hypotheses = {{row, 0}}});
    row += 3;
  }
}

void RangeSlam::predict(const BodyMotion& motion) {
  driven_ += motion.step.at().norm();
  const Pose2 pose = pose_of(mean_.head<3>());
  const MotionJacobians j = motion_jacobians(pose, motion.step);
  mean_.head<3>() = (pose * motion.step).vector();
  const Eigen::Index others = mean_.size() - 3;
  covariance_.topRightCorner(3, others) = (j.by_pose * covariance_.topRightCorner(3, others)).eval();
  covariance_.bottomLeftCorner(others, 3) = covariance_.topRightCorner(3, others).transpose();
  const Eigen::Matrix3d own = j.by_pose * covariance_.topLeftCorner<3, 3>() * j.by_pose.transpose() +
                              j.by_step * motion.covariance * j.by_step.transpose();
  covariance_.topLeftCorner<3, 3>() = (own + own.transpose()) / 2;
}

// The range is sqrt(d^2 + h^2) + offset. Its second derivative across the line of sight is corrected for as
// in correct_curvature().
RangeSlam::Prediction RangeSlam::predict_range(const Pose2& mount, const Beacon& beacon,
                                               Eigen::Index row) const {
  const Pose2 robot = pose_of(mean_.head<3>());
  const Eigen::Vector2d lever = (robot * mount).at() - robot.at();
  const Eigen::Vector2d to = mean_.segment<2>(row) - robot.at() - lever;
  const double flat = std::max(to.norm(), 1e-3), range = std::hypot(flat, beacon.height);
  const Eigen::Vector2d along = to / flat, across(-along.y(), along.x());
  Prediction p{.row = Eigen::VectorXd::Zero(mean_.size())};
  const Eigen::Vector2d by_position = along * (flat / range);
  p.row.segment<2>(row) = by_position;
  p.row[row + 2] = 1;
  p.row.head<2>() = -by_position;
  p.row[2] = by_position.x() * lever.y() - by_position.y() * lever.x();
  Eigen::VectorXd side = Eigen::VectorXd::Zero(mean_.size());
  side.segment<2>(row) = across;
  side.head<2>() = -across;
  side[2] = across.x() * lever.y() - across.y() * lever.x();
  const double variance = std::max(0.0, side.dot(covariance_ * side));
  const double curvature = variance / std::max(range, std::sqrt(variance));
  p.value = range + mean_[row + 2] + curvature / 2;
  p.variance = curvature * curvature / 2;
  return p;
}

// Joseph form, (I - K H) P (I - K H)' + K N K': positive for any gain.
void RangeSlam::apply(const Eigen::MatrixXd& gain, const Measurement& m) {
  mean_ += gain * m.innovation;
  mean_[2] = wrap_angle(mean_[2]);
  const Eigen::MatrixXd kept = covariance_ - gain * (m.rows * covariance_);
  covariance_ = kept - (kept * m.rows.transpose()) * gain.transpose() + gain * m.noise * gain.transpose();
  covariance_ = ((covariance_ + covariance_.transpose()) / 2).eval();
}

// Rows outside of the segment are considered but not corrected.
void RangeSlam::correct(const Prediction& p, double innovation, double noise, Eigen::Index first,
                        Eigen::Index count) {
  const Eigen::VectorXd with = covariance_ * p.row;
  const double s = p.row.dot(with) + noise;
  Eigen::VectorXd gain = Eigen::VectorXd::Zero(mean_.size());
  gain.segment(first, count) = with.segment(first, count) / s;
  apply(gain, {p.row.transpose(), Eigen::VectorXd::Constant(1, innovation),
               Eigen::MatrixXd::Constant(1, 1, noise)});
}

bool RangeSlam::update(Beacon& beacon, const SeenLandmark& seen, const Pose2& mount) {
  const Prediction p = predict_range(mount, beacon, beacon.hypotheses[0].row);
  const double v = *seen.range - p.value, noise = seen.range_sd * seen.range_sd + p.variance;
  if (!(v * v <= kRangeGate * (p.row.dot(covariance_ * p.row) + noise))) return false;
  correct(p, v, noise, 0, mean_.size());
  return true;
}

bool RangeSlam::is_confirmed(const SeenLandmark& seen) {
  const FirstRange now{*seen.identity, *seen.range, driven_};
  const auto before = std::ranges::find(first_, now.key, &FirstRange::key);
  if (before == first_.end()) {
    first_.push_back(now);
    return false;
  }
  const double possible = driven_ - before->driven + 4 * seen.range_sd;
  if (std::abs(now.range - before->range) <= possible) {
    first_.erase(before);
    return true;
  }
  if (now.range < before->range) *before = now;
  return false;
}

void RangeSlam::start_ring(const SeenLandmark& seen, const Pose2& mount) {
  const Pose2 robot = pose_of(mean_.head<3>());
  const Eigen::Vector2d sensor = (robot * mount).at(), lever = sensor - robot.at();
  const Eigen::Index row = mean_.size(), size = row + 3 * kRing;
  Beacon beacon{.key = *seen.identity};
  mean_.conservativeResize(size);
  covariance_.conservativeResize(size, size);
  covariance_.rightCols(3 * kRing).setZero(), covariance_.bottomRows(3 * kRing).setZero();
  Eigen::Matrix<double, 3, 3> by_pose = Eigen::Matrix3d::Zero();
  by_pose.topLeftCorner<2, 3>() << 1, 0, -lever.y(), 0, 1, lever.x();
  const double offset = options_.offset_sd * options_.offset_sd;
  const double tangential = std::pow(*seen.range * std::numbers::pi / kRing, 2) / 2;
  for (int k = 0; k < kRing; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / kRing;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    const Eigen::Index at = row + 3 * k;
    mean_.segment<2>(at) = sensor + *seen.range * along;
    mean_[at + 2] = 0;
    covariance_.block(at, 0, 3, row) = by_pose * covariance_.topLeftCorner(3, row);
    covariance_.block(0, at, row, 3) = covariance_.block(at, 0, 3, row).transpose();
    // Hypotheses exclude each other: covariances between them have no effect.
    Eigen::Matrix3d own = by_pose * covariance_.topLeftCorner<3, 3>() * by_pose.transpose();
    own.topLeftCorner<2, 2>() += (seen.range_sd * seen.range_sd + offset) * along * along.transpose() +
                                 tangential * across * across.transpose();
    own.topRightCorner<2, 1>() -= offset * along;
    own.bottomLeftCorner<1, 2>() -= offset * along.transpose();
    own(2, 2) += offset;
    covariance_.block<3, 3>(at, at) = own;
    beacon.hypotheses.push_back({at, -std::log(double(kRing))});
  }
  beacons_.push_back(std::move(beacon));
}

void RangeSlam::weigh(Beacon& beacon, const SeenLandmark& seen, const Pose2& mount) {
  double largest = -1e300;
  for (Hypothesis& h : beacon.hypotheses) {
    const Prediction p = predict_range(mount, beacon, h.row);
    const double v = *seen.range - p.value, noise = seen.range_sd * seen.range_sd + p.variance;
    const double s = p.row.dot(covariance_ * p.row) + noise;
    const double seen_so = (1 - options_.outliers) * std::exp(-v * v / (2 * s)) /
                           std::sqrt(2 * std::numbers::pi * s),
                 echo = options_.outliers / kEchoes;
    h.log_weight += std::log(seen_so + echo);
    largest = std::max(largest, h.log_weight);
    // The less likely a range is that of the beacon, the less it corrects.
    const double probability = seen_so / (seen_so + echo);
    if (probability > 0.5) correct(p, v, noise / probability, h.row, 3);
  }
  double sum = 0;
  for (const Hypothesis& h : beacon.hypotheses) sum += std::exp(h.log_weight - largest);
  for (Hypothesis& h : beacon.hypotheses) h.log_weight -= largest + std::log(sum);
  prune(beacon);
}

void RangeSlam::remove_rows(Eigen::Index row) {
  const Eigen::Index after = mean_.size() - row - 3;
  mean_.segment(row, after) = mean_.tail(after).eval();
  covariance_.middleRows(row, after) = covariance_.bottomRows(after).eval();
  covariance_.middleCols(row, after) = covariance_.rightCols(after).eval();
  mean_.conservativeResize(row + after);
  covariance_.conservativeResize(row + after, row + after);
  for (Beacon& b : beacons_)
    for (Hypothesis& h : b.hypotheses)
      if (h.row > row) h.row -= 3;
}

void RangeSlam::prune(Beacon& beacon) {
  auto& all = beacon.hypotheses;
  const auto remove = [&](std::size_t i) {
    const Eigen::Index row = all[i].row;
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
    remove_rows(row);
  };
  std::ranges::stable_sort(all, std::greater<>{}, &Hypothesis::log_weight);
  for (std::size_t i = all.size(); i-- > 1;)
    if (all[i].log_weight < std::log(kPruned)) remove(i);
  // Neighbours on the ring move to one position.
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = all.size(); k-- > i + 1;) {
      const Eigen::Vector2d d = mean_.segment<2>(all[i].row) - mean_.segment<2>(all[k].row);
      const Eigen::Matrix2d spread =
          covariance_.block<2, 2>(all[i].row, all[i].row) + covariance_.block<2, 2>(all[k].row, all[k].row);
      if (!(spread.trace() < 2 * kMaxOpenSd * kMaxOpenSd) || !(d.dot(spread.inverse() * d) < kSamePosition))
        continue;
      all[i].log_weight = std::log(std::exp(all[i].log_weight) + std::exp(all[k].log_weight));
      remove(k);
    }
  if (all.size() < 2 || !(all[0].log_weight > std::log(kDecided)) ||
      !(covariance_.block<2, 2>(all[0].row, all[0].row).trace() < kMaxOpenSd * kMaxOpenSd))
    return;
  while (all.size() > 1) remove(all.size() - 1);
}

std::vector<Match> RangeSlam::update(const SightingSet& seen) {
  std::vector<Match> matches(seen.sightings.size());
  for (std::size_t i = 0; i < seen.sightings.size(); ++i) {
    const SeenLandmark& s = seen.sightings[i];
    Match& match = matches[i];
    match.verdict = Verdict::unsound;
    if (!s.is_valid()) continue;
    match.verdict = Verdict::ambiguous;
    if (s.bearing || !s.identity) continue;
    const auto known = std::ranges::find(beacons_, *s.identity, &Beacon::key);
    if (known == beacons_.end()) {
      if (is_confirmed(s)) start_ring(s, seen.robot_from_sensor);
    } else if (known->is_open()) {
      weigh(*known, s, seen.robot_from_sensor);
    } else if (update(*known, s, seen.robot_from_sensor)) {
      match.verdict = Verdict::matched;
      match.key = *s.identity;
    } else {
      match.verdict = Verdict::too_far;
    }
  }
  return matches;
}

bool RangeSlam::measure(const Measurement& m) {
  const Eigen::MatrixXd with = covariance_ * m.rows.transpose();
  const Eigen::MatrixXd inverse = (m.rows * with + m.noise).inverse();
  if (!(m.innovation.dot(inverse * m.innovation) <= kFixGateSquares)) return false;
  apply(with * inverse, m);
  return true;
}

bool RangeSlam::fix(const GnssFix& gnss) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, mean_.size());
  rows(0, 0) = rows(1, 1) = 1;
  return measure({rows, gnss.at - mean_.head<2>(), gnss.sd * gnss.sd * Eigen::Matrix2d::Identity()});
}

bool RangeSlam::fix(const HeadingFix& heading) {
  Eigen::MatrixXd row = Eigen::MatrixXd::Zero(1, mean_.size());
  row(0, 2) = 1;
  return measure({row, Eigen::VectorXd::Constant(1, wrap_angle(heading.yaw - mean_[2])),
                  Eigen::MatrixXd::Constant(1, 1, heading.sd * heading.sd)});
}

PoseEstimate RangeSlam::estimate() const {
  return {pose_of(mean_.head<3>()), covariance_.topLeftCorner<3, 3>()};
}

std::vector<RangeSlam::Placed> RangeSlam::beacons() const {
  std::vector<Placed> all;
  for (const Beacon& b : beacons_) {
    if (b.is_open()) continue;
    const Eigen::Index row = b.hypotheses[0].row;
    all.push_back({b.key, mean_.segment<3>(row), covariance_.block<3, 3>(row, row)});
  }
  return all;
}

std::size_t RangeSlam::open_beacons() const {
  return static_cast<std::size_t>(std::ranges::count_if(beacons_, &Beacon::is_open));
}

}  // namespace waymark::localization
