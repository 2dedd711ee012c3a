// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/convergence.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {
namespace {

constexpr double kShare = 0.35, kMinExplained = 0.2;
constexpr double kSame = 2, kSameYaw = 0.5;  // m, rad, beside three standard deviations

}  // namespace

bool has_bearing(const SightingSet& seen) {
  return std::ranges::any_of(seen.sightings, [](const SeenLandmark& s) { return s.is_valid() && s.bearing; });
}

void Convergence::fix(const GnssFix& gnss) {
  const double variance = 4 * gnss.sd * gnss.sd;  // GNSS errors are correlated
  if (!(variance < prior_.covariance(0, 0) + prior_.covariance(1, 1))) return;
  const double yaw = prior_.covariance(2, 2);
  prior_.pose.x = gnss.at.x(), prior_.pose.y = gnss.at.y();
  prior_.covariance = Eigen::Vector3d(variance, variance, yaw).asDiagonal();
}

void Convergence::count(double fit, double chance, bool unimodal, bool located) {
  if (!unimodal) reset();
  explained_.add(fit, chance);
  if (!explained_.known()) return;
  if (found_)
    found_ = explained_.value() > kMinExplained;
  else
    found_ = identities_ && located && explained_.value() > kShare;
}

void Convergence::confirm(const PoseEstimate& sure, const PoseEstimate& here) {
  const double sd = std::sqrt(sure.covariance.topLeftCorner<2, 2>().trace() +
                              here.covariance.topLeftCorner<2, 2>().trace());
  const double yaw_sd = std::sqrt(sure.covariance(2, 2) + here.covariance(2, 2));
  found_ = (sure.pose.at() - here.pose.at()).norm() < 3 * sd + kSame &&
           std::abs(wrap_angle(sure.pose.yaw - here.pose.yaw)) < 3 * yaw_sd + kSameYaw;
}

PoseEstimate Convergence::inflate_covariance(PoseEstimate estimate) const {
  if (found_) return estimate;
  const Eigen::Vector2d off = prior_.pose.at() - estimate.pose.at();
  estimate.covariance.topLeftCorner<2, 2>() +=
      prior_.covariance.topLeftCorner<2, 2>() + off * off.transpose();
  estimate.covariance(2, 2) = std::max(estimate.covariance(2, 2), prior_.covariance(2, 2));
  return estimate;
}

}  // namespace waymark::localization
