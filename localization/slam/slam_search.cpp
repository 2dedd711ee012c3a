// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/slam_search.hpp"

#include <algorithm>
#include <utility>

#include "localization/slam/ekf_slam.hpp"
#include "localization/slam/existence.hpp"

namespace waymark {
namespace {

constexpr double kFade = 0.1, kSlowFade = 0.01;  // of the fit and the usual fit, per set
constexpr double kLostFade = 0.002;              // of the usual fit while lost
constexpr double kNoDoubt = 0.6;                 // part of the usual fit above which nobody is asked
constexpr int kWait = 5, kDoubt = 10, kStrayed = 10;

}  // namespace

void SlamSearch::move(const BodyMotion& motion) {
  memory_.move(motion);
  if (rival_) rival_ = moved(*rival_, motion);
}

std::optional<PoseEstimate> SlamSearch::see(const SightingSet& seen, int expected, int found, int matched,
                                            const PoseEstimate& here) {
  memory_.add(seen);
  if (expected > 0) {
    ++sets_;  // at first it is where it was told, and learns how much a sensor sees
    const double share = static_cast<double>(found) / expected;
    fit_ += std::max(kFade, 1.0 / sets_) * (share - fit_);
    usual_ += std::max(lost() ? kLostFade : kSlowFade, 1.0 / sets_) * (share - usual_);
  }
  if (seen.sightings.empty()) return {};
  strayed_ = matched > 0 ? 0 : strayed_ + 1;
  const bool searching = lost() || strayed_ >= kStrayed;
  if (!searching && fit_ > kNoDoubt * usual_) {
    waited_ = 0;
    return {};
  }
  if (++waited_ < (searching ? kWait : kDoubt)) return {};
  waited_ = 0;
  FoundPoses answer = finder_(with_bearings(memory_.recall(), seen));
  const std::optional<PoseEstimate> before = std::exchange(rival_, std::nullopt);
  if (!answer.sure || !are_apart(*answer.sure, here)) return {};
  if (!before || are_apart(*answer.sure, *before)) {
    rival_ = answer.sure;
    return {};
  }
  fit_ = usual_;
  answer.sure->covariance *= 4;
  return answer.sure;
}

void EkfSlam::search_with(PoseFinder finder) {
  search_.emplace(std::move(finder));
}

Trust EkfSlam::trust() const {
  return search_ && search_->lost() ? Trust::lost : Trust::sure;
}

void EkfSlam::look_for_place(const SightingSet& seen, const std::vector<Near>& near,
                             const std::vector<bool>& found) {
  int expected = 0, of_those = 0, matched = 0;
  for (const auto& [i, is_expected] : near) {
    if (!landmarks_[i].of_map || landmarks_[i].gone) continue;
    expected += is_expected, of_those += is_expected && found[i], matched += found[i];
  }
  if (const auto at = search_->see(seen, expected, of_those, matched, estimate())) {
    begin_anew(*at);
    ++restarts_;
    return;
  }
  if (!search_->lost() && matched > 0) trusted_ = landmarks_.size();
}

void EkfSlam::begin_anew(const PoseEstimate& at) {
  state_.focus(1e9);
  SlamState fresh(at);
  of_slot_.clear();
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    SlamLandmark& l = landmarks_[i];
    if (l.of_map) {  // as the map has it: what was learnt while lost is of other landmarks
      l.at = map_[i].at, l.covariance = map_[i].covariance;
      l.log_odds = std::max(l.log_odds, log_odds(map_[i].quality));
      l.gone = false;
      if (l.key) of_key_.insert_or_assign(*l.key, i);
      l.slot.reset();
    } else if (l.slot) {
      l.at = state_.at(*l.slot), l.covariance = state_.covariance(*l.slot);
      l.slot.reset();
      if (i >= trusted_) {  // placed from a wrong pose
        l.gone = true;
        if (l.key) of_key_.erase(*l.key);
        continue;
      }
      l.slot = fresh.add(l.at, l.covariance);
      of_slot_.resize(*l.slot + 1);
      of_slot_[*l.slot] = i;
    }
  }
  state_ = std::move(fresh);
  pending_ = {};
  centre_ = at.pose.at();
}

}  // namespace waymark
