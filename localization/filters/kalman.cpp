// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/kalman.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>

namespace waymark::localization {
namespace {

constexpr double kCertain = 0.999;  // pairings above this need no mixture

}  // namespace

Eigen::Vector3d clamp_sd(const Eigen::Vector3d& sd) {
  return sd.cwiseMin(Eigen::Vector3d(1e4, 1e4, 3)).cwiseMax(Eigen::Vector3d(0.05, 0.05, 0.02));
}

void KalmanOptions::describe(OptionVisitor& option) {
  option("lost_after", lost_after,
         {.help = "Consecutive sets of sightings without a match before the filter searches",
          .min = 1,
          .max = 1e9});
  option("search_growth", search_growth,
         {.help = "Growth of the standard deviations per set while searching", .min = 1, .max = 10});
}

KalmanLocalizer::KalmanLocalizer(LandmarkMatcher matcher, KalmanOptions options)
    : matcher_(std::move(matcher)), options_(options) {}

std::vector<Match> KalmanLocalizer::update(const SightingSet& seen) {
  const PoseEstimate before = estimate();
  matcher_.observe(seen);
  const LandmarkGrid& map = matcher_.landmarks_near(seen, before);
  auto [matches, posterior] = matcher_.identify(seen, before, map);
  matcher_.learn(matches, seen, before, map);
  std::vector<MatchedSighting> uses;
  bool doubtful = false, strange = false;
  // Ranges to landmarks that identify themselves compete with echoes alone: each is associated by itself.
  const bool apart = std::ranges::all_of(seen.sightings, [&](const SeenLandmark& s) {
    return !s.bearing && s.identity && matcher_.options().use_identities;
  });
  for (std::size_t i = 0; i < matches.size(); ++i) {
    Match& match = matches[i];
    doubtful = doubtful || match.verdict == Verdict::ambiguous || match.probability < kCertain;
    strange = strange || match.verdict == Verdict::nothing_near || match.verdict == Verdict::too_far;
    if (match.verdict != Verdict::matched) continue;
    const MapLandmark& landmark = map[match.pairing.landmark];
    name_landmark(match, landmark);
    uses.push_back({&seen.sightings[i], &landmark, noise_divisor(landmark, matcher_.options()),
                    apart ? match.probability : 1});
  }
  if (posterior && doubtful && !apart) {
    missed_ = 0;
    replace(*posterior);
  } else if (!uses.empty()) {
    missed_ = 0;
    correct(uses, seen.robot_from_sensor);
    for (const MatchedSighting& use : uses) correct_heading(*use.seen, seen.robot_from_sensor, *use.landmark);
  } else if (strange && ++missed_ >= options_.lost_after && options_.search_growth > 1) {
    widen(options_.search_growth);
  }
  return matches;
}

void KalmanLocalizer::correct_heading(const SeenLandmark& seen, const Pose2& robot_from_sensor,
                                      const MapLandmark& landmark) {
  for (const AngleFix& fix : headings_from_angles(seen, robot_from_sensor, landmark, estimate().pose.yaw,
                                                  matcher_.scales(), matcher_.options()))
    replace(update_pose(estimate(), fix.heading).estimate);
}

// Position and heading are components of the state: the update is linear, the same for both filters.
template <class Fix>
bool KalmanLocalizer::apply_fix(const Fix& measured, int rows) {
  FixGate& gate = rows == 2 ? gnss_ : heading_;
  FixUpdate update = update_pose(estimate(), measured);
  if (!gate.pass(update.squares, rows)) return false;
  if (gate.was_forced()) {
    for (int i = 0; i < 40 && update.squares > 4; ++i) {
      widen(2);
      update = update_pose(estimate(), measured);
    }
  }
  replace(update.estimate);
  return true;
}
template bool KalmanLocalizer::apply_fix(const GnssFix&, int);
template bool KalmanLocalizer::apply_fix(const HeadingFix&, int);

ExtendedKalman::ExtendedKalman(const PoseEstimate& start, LandmarkMatcher matcher, KalmanOptions options)
    : KalmanLocalizer(std::move(matcher), options), estimate_(start), errors_(options.error_memory_distance) {
  if (!start.pose.finite() || !start.covariance.allFinite())
    throw std::invalid_argument("the start of a filter must be finite");
}

void ExtendedKalman::predict(const BodyMotion& motion) {
  errors_.predict(estimate_.pose, motion.step);
  estimate_ = predict_pose(estimate_, motion);
}

void ExtendedKalman::correct(const std::vector<MatchedSighting>& uses, const Pose2& robot_from_sensor) {
  for (const MatchedSighting& use : uses)
    estimate_ = errors_.correct_probably(estimate_, *use.seen, robot_from_sensor, *use.landmark, use.trust,
                                         use.probability);
}

void ExtendedKalman::replace(const PoseEstimate& estimate) {
  errors_.follow(estimate_, estimate);
  estimate_ = estimate;
}

void ExtendedKalman::widen(double factor) {
  const Eigen::Vector3d sd = estimate_.covariance.diagonal().cwiseSqrt();
  const Eigen::Vector3d wide = clamp_sd(sd * factor);
  // Drops correlations: the estimate was wrong.
  estimate_.covariance = wide.cwiseAbs2().asDiagonal();
  errors_.clear();
}

PoseEstimate ekf_update(const PoseEstimate& estimate, const SeenLandmark& measured,
                        const Pose2& robot_from_sensor, const MapLandmark& landmark, double trust) {
  std::optional<SeenLandmark> corrected;
  if (!measured.bearing) corrected = correct_curvature(measured, estimate, robot_from_sensor, landmark.at);
  const SeenLandmark& seen = corrected ? *corrected : measured;
  const ExpectedSighting e = expect(estimate.pose, robot_from_sensor, measured, landmark);
  Eigen::Matrix<double, 2, 3> h = e.by_pose;
  Eigen::Matrix2d r =
      (sensor_noise(seen) + e.by_landmark * landmark.covariance * e.by_landmark.transpose()) / trust;
  const Eigen::Vector2d v = innovation(seen, e.value);
  Eigen::Matrix2d by_landmark = e.by_landmark;
  omit_missing(seen, h, by_landmark, r);
  const Eigen::Matrix3d& p = estimate.covariance;
  const Eigen::Matrix<double, 3, 2> ph = p * h.transpose();
  const Eigen::Matrix2d s = h * ph + r;
  const Eigen::Matrix<double, 3, 2> gain = ph * s.inverse();
  const Eigen::Matrix3d a = Eigen::Matrix3d::Identity() - gain * h;
  const Eigen::Matrix3d after = a * p * a.transpose() + gain * r * gain.transpose();
  return {pose_of(estimate.pose.vector() + gain * v), (after + after.transpose()) / 2};
}

}  // namespace waymark::localization
