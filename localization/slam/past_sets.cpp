// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/past_sets.hpp"

#include <cmath>

#include "localization/filters/regain_evidence.hpp"
#include "localization/global/pose_claims.hpp"

namespace waymark::localization {
namespace {

constexpr double kLength = 30, kStep = 0.5, kTurn = 0.5;  // m, m, rad
constexpr std::size_t kMaxSets = 100;
// A robot that drives on sees most of what it saw before; one that was carried, something by chance.
constexpr double kKept = 0.7, kMinFound = 0.25, kMinExpected = 5;
constexpr double kLogCertain = -9.2;  // ln of the probability that chance favours SLAM as much

}  // namespace

void PastSets::add(const SightingSet& seen, const PoseEstimate& robot, int found, int expected) {
  found_ = kKept * found_ + found;
  expected_ = kKept * expected_ + expected;
  if (expected_ > kMinExpected && found_ < kMinFound * expected_) {
    sets_.clear();
    return;
  }
  while (!sets_.empty() && driven_ - sets_.front().driven > kLength) sets_.pop_front();
  if (!sets_.empty() && driven_ - sets_.back().driven < kStep &&
      std::abs(wrap_angle(robot.pose.yaw - sets_.back().robot.pose.yaw)) < kTurn)
    return;
  if (sets_.size() == kMaxSets) sets_.pop_front();
  sets_.push_back({seen, robot, driven_});
}

void PastSets::move(const Pose2& from, const Pose2& to) {
  const Pose2 by = to * inverse(from);
  for (Past& past : sets_) past.robot.pose = by * past.robot.pose;
}

bool PastSets::contradict(const PoseEstimate& rival, const PoseEstimate& robot,
                          const Explain& explain) const {
  int for_own = 0, for_rival = 0;
  for (const Past& past : sets_) {
    const BodyMotion back{inverse(robot.pose) * past.robot.pose};
    PoseEstimate there = predict_pose(rival, back);
    there.covariance += past.robot.covariance;
    if (is_in_reach(there, past.robot, driven_ - past.driven)) continue;
    const std::vector<bool> own = explain(past.seen, past.robot), other = explain(past.seen, there);
    for (std::size_t k = 0; k < own.size(); ++k)
      for_own += own[k] && !other[k], for_rival += other[k] && !own[k];
    if (log_binomial_tail(for_own, for_own + for_rival, 0.5) < kLogCertain) return true;
  }
  return false;
}

}  // namespace waymark::localization
