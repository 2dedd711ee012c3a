// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/convergence.hpp"

#include <algorithm>

namespace waymark::localization {
namespace {

constexpr double kShare = 0.35, kMinExplained = 0.2;
constexpr double kSame = 2;  // m, beside three standard deviations

}  // namespace

void Convergence::fix(const GnssFix& gnss) {
  const double variance = 4 * gnss.sd * gnss.sd;  // GNSS errors are correlated
  if (!(variance < prior_.covariance(0, 0) + prior_.covariance(1, 1))) return;
  const double yaw = prior_.covariance(2, 2);
  prior_.pose.x = gnss.at.x(), prior_.pose.y = gnss.at.y();
  prior_.covariance = Eigen::Vector3d(variance, variance, yaw).asDiagonal();
}

void Convergence::count(double fit, double chance, bool unimodal) {
  if (!unimodal) reset();
  explained_.add(fit, chance);
  if (!explained_.known()) return;
  if (found_)
    found_ = explained_.value() > kMinExplained;
  else
    found_ = identities_ && explained_.value() > kShare;
}

void Convergence::confirm(const PoseEstimate& sure, const PoseEstimate& here) {
  const double sd = std::sqrt(sure.covariance.topLeftCorner<2, 2>().trace() +
                              here.covariance.topLeftCorner<2, 2>().trace());
  found_ = (sure.pose.at() - here.pose.at()).norm() < 3 * sd + kSame;
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
