// SPDX-License-Identifier: Apache-2.0
#include "localization/global/pose_claims.hpp"

#include <cmath>

namespace waymark::localization {
namespace {

constexpr int kAnswers = 3;                // that agree about a pose out of reach
constexpr double kMaxOdometryError = 0.3;  // m per metre driven, beyond what the covariance states

}  // namespace

bool is_in_reach(const PoseEstimate& found, const PoseEstimate& reckoned, double driven) {
  const double sd = std::sqrt((reckoned.covariance + found.covariance).topLeftCorner<2, 2>().trace());
  const double distance = (found.pose.at() - reckoned.pose.at()).norm();
  return distance < 1 + 4 * sd + kMaxOdometryError * driven;
}

void PoseClaims::predict(const BodyMotion& motion) {
  driven_ += motion.step.at().norm();
  if (claim_) claim_ = predict_other_pose(*claim_, motion);
}

PoseClaims::Verdict PoseClaims::judge(const PoseEstimate& found, const PoseEstimate& reckoned) {
  if (is_in_reach(found, reckoned, driven_)) return Verdict::accepted;
  answers_ = claim_ && !are_distinct(found, *claim_) ? answers_ + 1 : 1;
  claim_ = found;
  return answers_ < kAnswers ? Verdict::open : Verdict::accepted;
}

}  // namespace waymark::localization
