// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/cloud_covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

namespace waymark::localization {
namespace {

constexpr double kMaxSpread = 4;  // of the cloud over its own assumptions: particles disagree beyond noise

bool is_usable(const Eigen::Matrix3d& covariance) {
  return covariance.allFinite() && Eigen::LLT<Eigen::Matrix3d>(covariance).info() == Eigen::Success;
}

}  // namespace

void CloudCovariance::predict(const Pose2& from, const BodyMotion& motion) {
  errors_.predict(from, motion.step);
  real_ = predict_pose({from, real_}, motion).covariance;
}

void CloudCovariance::follow_sightings(const PoseEstimate& before, const PoseEstimate& after,
                                       const SightingSet& seen, const std::vector<Match>& matches,
                                       const LandmarkGrid& map,
                                       const std::function<double(LandmarkKey)>& factor) {
  MapErrors::Covariances both{real_, before.covariance};
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].verdict != Verdict::matched) continue;
    const MapLandmark& landmark = map[matches[i].pairing.landmark];
    both = errors_.follow(before.pose, both, seen.sightings[i], seen.robot_from_sensor, landmark,
                          factor(landmark.key));
  }
  if (!(after.covariance.trace() < kMaxSpread * both.assumed.trace()) || !is_usable(both.real))
    return reset(after);
  real_ = both.real;
  // Sightings without a certain pairing corrected the cloud, too.
  const bool followed =
      std::ranges::all_of(matches, [](const Match& m) { return m.verdict == Verdict::matched; });
  if (!followed && after.covariance.trace() < both.assumed.trace())
    follow_independent({before.pose, both.assumed}, after);
}

void CloudCovariance::follow_independent(const PoseEstimate& before, const PoseEstimate& after) {
  const Eigen::Matrix3d change =
      after.covariance * (before.covariance + 1e-12 * Eigen::Matrix3d::Identity()).inverse();
  errors_.follow(before, after);
  real_ = change * (real_ - before.covariance) * change.transpose() + after.covariance;
  if (!is_usable(real_)) reset(after);
}

}  // namespace waymark::localization
