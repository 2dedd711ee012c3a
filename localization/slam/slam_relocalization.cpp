// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/slam_relocalization.hpp"

#include <algorithm>
#include <utility>

#include "localization/slam/ekf_slam.hpp"
#include "localization/slam/existence_log_odds.hpp"

namespace waymark::localization {
namespace {

constexpr double kFade = 0.1, kSlowFade = 0.01;  // decay of the fit and the usual fit, per set
constexpr double kLostFade = 0.002;              // decay of the usual fit while lost
constexpr double kConfident = 0.6;  // fraction of the usual fit above which the finder is not called
constexpr int kWait = 5, kCheckInterval = 10, kRoutineInterval = 20, kUnmatchedSets = 10;

}  // namespace

void SlamRelocalization::predict(const BodyMotion& motion) {
  memory_.predict(motion);
  if (rival_) rival_ = predict_pose(*rival_, motion);
}

std::optional<PoseEstimate> SlamRelocalization::update(const SightingSet& seen, int expected, int found,
                                                       int matched, const PoseEstimate& here) {
  memory_.add(seen);
  if (expected > 0) {
    ++sets_;  // starts at a known pose, and learns the detection rate of the sensor
    const double share = static_cast<double>(found) / expected;
    fit_ += std::max(kFade, 1.0 / sets_) * (share - fit_);
    usual_ += std::max(lost() ? kLostFade : kSlowFade, 1.0 / sets_) * (share - usual_);
  }
  if (seen.sightings.empty()) return {};
  unmatched_sets_ = matched > 0 ? 0 : unmatched_sets_ + 1;
  const bool searching = lost() || unmatched_sets_ >= kUnmatchedSets;
  const bool confident = !searching && fit_ > kConfident * usual_;
  if (++sets_since_query_ < (searching ? kWait : confident ? kRoutineInterval : kCheckInterval)) return {};
  sets_since_query_ = 0;
  PoseSearchResult answer = memory_.find(finder_, seen);
  const std::optional<PoseEstimate> before = std::exchange(rival_, std::nullopt);
  if (!answer.accepted) return {};
  if (!are_distinct(*answer.accepted, here)) {
    fit_ = std::max(fit_, usual_);  // it is where it thinks, whatever hides the landmarks
    return {};
  }
  if (!before || are_distinct(*answer.accepted, *before)) {
    rival_ = answer.accepted;
    return {};
  }
  fit_ = usual_;
  return answer.accepted;
}

void EkfSlam::set_pose_finder(PoseFinder finder) {
  search_.emplace(std::move(finder), scales_);
}

LocalizationStatus EkfSlam::status() const {
  return search_ && search_->lost() ? LocalizationStatus::lost : LocalizationStatus::tracking;
}

void EkfSlam::check_relocalization(const SightingSet& seen, const std::vector<Near>& near,
                                   const std::vector<bool>& found) {
  int expected = 0, of_those = 0, matched = 0;
  for (const auto& [i, is_expected] : near) {
    if (!landmarks_[i].was_mapped || landmarks_[i].gone) continue;
    expected += is_expected, of_those += is_expected && found[i], matched += found[i];
  }
  if (const auto at = search_->update(seen, expected, of_those, matched, estimate())) {
    restart(*at);
    ++restarts_;
    return;
  }
  if (!search_->lost() && matched > 0) trusted_ = landmarks_.size();
}

void EkfSlam::restart(const PoseEstimate& at) {
  state_.focus(1e9);
  SlamState fresh(at);
  landmark_by_slot_.clear();
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    SlamLandmark& l = landmarks_[i];
    if (l.was_mapped) {  // as in the map: what was learnt while lost belongs to other landmarks
      l.at = map_[i].at, l.covariance = map_[i].covariance;
      l.log_odds = std::max(l.log_odds, log_odds(l.quality));
      l.gone = false;
      if (l.key) landmark_by_key_.insert_or_assign(*l.key, i);
      l.slot.reset();
    } else if (l.slot) {
      l.at = state_.at(*l.slot), l.covariance = state_.covariance(*l.slot);
      l.slot.reset();
      if (i >= trusted_) {  // created at a wrong pose
        l.gone = true;
        if (l.key) landmark_by_key_.erase(*l.key);
        continue;
      }
      l.slot = fresh.add(l.at, l.covariance);
      landmark_by_slot_.resize(*l.slot + 1);
      landmark_by_slot_[*l.slot] = i;
    }
  }
  state_ = std::move(fresh);
  pending_ = {};
  centre_ = at.pose.at();
}

}  // namespace waymark::localization
