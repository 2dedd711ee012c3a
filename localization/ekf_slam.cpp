// SPDX-License-Identifier: Apache-2.0
#include "localization/ekf_slam.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "localization/measurement.hpp"

namespace waymark {

void SlamOptions::describe(OptionVisitor& option) {
  option("slam_match", match,
         {.help = "Squared Mahalanobis distance up to which a sighting is a landmark", .min = 0});
  option("slam_fresh", fresh, {.help = "and beyond which it is a new one", .min = 0});
  option("slam_nearest", nearest, {.help = "Metres between two landmarks at least", .min = 0});
  option("slam_range", most_range, {.help = "Metres up to which sightings are used", .min = 0.1});
  option("slam_seen", seen, {.help = "Log odds of existence that a match adds", .min = 0});
  option("slam_unseen", unseen, {.help = "Log odds that being expected and not seen adds", .max = 0});
  option("slam_confirmed", confirmed, {.help = "Log odds from which a landmark moves the robot"});
  option("slam_dropped", dropped, {.help = "Log odds below which a landmark is forgotten"});
  option("slam_view", field_of_view,
         {.help = "Radians to each side where sightings are expected", .min = 0, .max = 3.15});
}

EkfSlam::EkfSlam(const PoseEstimate& start, SlamOptions options)
    : options_(options), pose_(start.pose), covariance_(start.covariance) {}

PoseEstimate EkfSlam::estimate() const {
  return moved({pose_, covariance_.topLeftCorner<3, 3>()}, pending_);
}

void EkfSlam::move(const BodyMotion& motion) {
  pending_ = then(pending_, motion);
}

// The landmarks' correlations with the robot turn with it: once per set of sightings, not per odometry
// reading.
void EkfSlam::settle() {
  const Eigen::Index n = covariance_.rows();
  const MotionJacobians j = motion_jacobians(pose_, pending_.step);
  const PoseEstimate robot = estimate();
  const Eigen::MatrixXd cross = j.by_pose * covariance_.topRightCorner(3, n - 3);
  covariance_.topLeftCorner<3, 3>() = robot.covariance;
  covariance_.topRightCorner(3, n - 3) = cross;
  covariance_.bottomLeftCorner(n - 3, 3) = cross.transpose();
  pose_ = robot.pose;
  pending_ = {};
}

void EkfSlam::update(const SeenLandmark& seen, const Pose2& mount, std::size_t landmark) {
  const Eigen::Index n = covariance_.rows(), l = row(landmark);
  const ExpectedSighting e = expect(pose_, mount, landmarks_[landmark].at);
  Eigen::MatrixXd ph = covariance_.leftCols<3>() * e.by_pose.transpose();
  ph += covariance_.middleCols<2>(l) * e.by_landmark.transpose();
  const Eigen::Matrix2d s =
      e.by_pose * ph.topRows<3>() + e.by_landmark * ph.middleRows<2>(l) + sensor_noise(seen);
  const Eigen::MatrixXd gain = ph * s.inverse();
  const Eigen::VectorXd step = gain * innovation(seen, e.value);
  pose_ = pose_of(pose_.vector() + step.head<3>());
  for (std::size_t i = 0; i < landmarks_.size(); ++i) landmarks_[i].at += step.segment<2>(row(i));
  covariance_.selfadjointView<Eigen::Lower>().rankUpdate(gain.col(0), ph.col(0), -0.5);
  covariance_.selfadjointView<Eigen::Lower>().rankUpdate(gain.col(1), ph.col(1), -0.5);
  covariance_.triangularView<Eigen::StrictlyUpper>() = covariance_.transpose();
  (void)n;
}

void EkfSlam::add(const SeenLandmark& seen, const Pose2& mount) {
  const Pose2 sensor = pose_ * mount;
  const double along = sensor.yaw + seen.bearing;
  SlamLandmark fresh;
  fresh.at = sensor.at() + *seen.range * Eigen::Vector2d(std::cos(along), std::sin(along));
  const ExpectedSighting e = expect(pose_, mount, fresh.at);
  const Eigen::Matrix2d back = e.by_landmark.inverse();
  const Eigen::Matrix<double, 2, 3> by_pose = -back * e.by_pose;
  const Eigen::Index n = covariance_.rows();
  const Eigen::MatrixXd cross = by_pose * covariance_.topRows<3>();
  covariance_.conservativeResize(n + 2, n + 2);
  covariance_.block(n, 0, 2, n) = cross;
  covariance_.block(0, n, n, 2) = cross.transpose();
  covariance_.bottomRightCorner<2, 2>() = by_pose * covariance_.topLeftCorner<3, 3>() * by_pose.transpose() +
                                          back * sensor_noise(seen) * back.transpose();
  landmarks_.push_back(fresh);
}

void EkfSlam::forget() {
  for (std::size_t i = landmarks_.size(); i-- > 0;) {
    if (landmarks_[i].log_odds >= options_.dropped) continue;
    const Eigen::Index l = row(i), n = covariance_.rows(), rest = n - l - 2;
    covariance_.middleRows(l, rest) = covariance_.bottomRows(rest).eval();
    covariance_.middleCols(l, rest) = covariance_.rightCols(rest).eval();
    covariance_.conservativeResize(n - 2, n - 2);
    landmarks_.erase(landmarks_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

std::vector<Match> EkfSlam::see(const SightingSet& seen) {
  settle();
  std::vector<Match> matches(seen.sightings.size());
  std::vector<Pair> pairs;
  std::vector<double> least(seen.sightings.size(), 1e9), closest(seen.sightings.size(), 1e9);
  std::vector<bool> expected(landmarks_.size(), false), found(landmarks_.size(), false);
  const Eigen::Matrix3d robot = covariance_.topLeftCorner<3, 3>();
  for (std::size_t l = 0; l < landmarks_.size(); ++l) {
    const Eigen::Vector2d to = landmarks_[l].at - pose_.at();
    if (to.squaredNorm() > (options_.most_range + 10) * (options_.most_range + 10)) continue;
    const ExpectedSighting e = expect(pose_, seen.robot_from_sensor, landmarks_[l].at);
    expected[l] = e.value[0] < 0.7 * options_.most_range && std::abs(e.value[1]) < options_.field_of_view;
    const Eigen::Index i = row(l);
    const Eigen::Matrix<double, 2, 3> cross = e.by_landmark * covariance_.block<2, 3>(i, 0);
    const Eigen::Matrix2d both = cross * e.by_pose.transpose();
    const Eigen::Matrix2d base = e.by_pose * robot * e.by_pose.transpose() + both + both.transpose() +
                                 e.by_landmark * covariance_.block<2, 2>(i, i) * e.by_landmark.transpose();
    for (std::size_t k = 0; k < matches.size(); ++k) {
      const SeenLandmark& s = seen.sightings[k];
      if (!s.sound() || !s.range || *s.range > options_.most_range) continue;
      const Eigen::Vector2d v = innovation(s, e.value);
      closest[k] = std::min(closest[k], std::hypot(v[0], v[1] * e.value[0]));
      if (std::abs(v[0]) > 10) continue;
      const double squares = v.dot((base + sensor_noise(s)).inverse() * v);
      least[k] = std::min(least[k], squares);
      if (squares < options_.match) pairs.push_back({squares, k, l});
    }
  }
  std::ranges::sort(pairs, {}, &Pair::squares);
  std::vector<Pair> chosen;
  for (const Pair& p : pairs) {
    if (found[p.landmark] || matches[p.sighting].verdict == Verdict::matched) continue;
    found[p.landmark] = true;
    matches[p.sighting].verdict = Verdict::matched;
    chosen.push_back(p);
  }
  for (const Pair& p : chosen) {
    SlamLandmark& l = landmarks_[p.landmark];
    l.log_odds = std::min(l.log_odds + options_.seen, 8.0);
    ++l.matches;
    update(seen.sightings[p.sighting], seen.robot_from_sensor, p.landmark);
  }
  for (std::size_t l = 0; l < expected.size(); ++l)
    if (expected[l] && !found[l]) landmarks_[l].log_odds += options_.unseen;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const SeenLandmark& s = seen.sightings[k];
    if (matches[k].verdict == Verdict::matched) continue;
    if (!s.sound() || !s.range) {
      matches[k].verdict = Verdict::unsound;
    } else if (*s.range > options_.most_range) {
      matches[k].verdict = Verdict::too_far;
    } else if (least[k] > options_.fresh && closest[k] > options_.nearest) {
      add(s, seen.robot_from_sensor);
      matches[k].verdict = Verdict::nothing_near;
    } else {
      matches[k].verdict = Verdict::ambiguous;
    }
  }
  forget();
  return matches;
}

}  // namespace waymark
