// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/restarting.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr int kWait = 5, kInVain = 20;           // sets between questions, and between fresh tries
constexpr double kFade = 0.1, kSlowFade = 0.01;  // of the fit and the usual fit, per set
constexpr double kLeastFit = 1.0 / 3, kLeastOfUsual = 0.5, kWell = 0.8, kByChance = 0.2;

}  // namespace

Restarting::Restarting(const PoseEstimate& start, Begin begin, PoseFinder finder, ChanceShare chance)
    : begin_(std::move(begin)),
      finder_(std::move(finder)),
      chance_(std::move(chance)),
      inner_(begin_(start)),
      carried_(start) {}

void Restarting::move(const BodyMotion& motion) {
  inner_->move(motion);
  memory_.move(motion);
  carried_ = moved(carried_, motion);
}

bool Restarting::lost() const {
  return by_chance_ || inner_->trust() == Trust::lost || fit_ < std::max(kLeastFit, kLeastOfUsual * usual_);
}

void Restarting::begin_anew(const PoseEstimate& at) {
  inner_ = begin_(at);
  in_vain_ = waited_ = 0;
  explained_.clear();
}

std::vector<Match> Restarting::see(const SightingSet& seen) {
  memory_.add(seen);
  std::vector<Match> matches = inner_->see(seen);
  const double fit = fitting_share(matches);
  if (fit >= 0) fit_ += kFade * (fit - fit_);
  if (chance_ && fit >= 0) {
    explained_.add(fit, chance_(seen, inner_->estimate()));
    by_chance_ = by_chance_ ? !proven() : explained_.known() && explained_.share() < kByChance;
  }
  if (!lost()) {
    in_vain_ = 0;
    if (fit >= 0) usual_ += kSlowFade * (fit_ - usual_);
    if (fit_ >= kWell * usual_ && proven()) carried_ = inner_->estimate();
    return matches;
  }
  if (seen.sightings.empty()) return matches;
  if (++waited_ >= kWait) {
    waited_ = 0;
    FoundPoses found = finder_(with_bearings(memory_.recall(), seen));
    if (found.sure) {
      // The finder does not know how odometry blurred what is remembered as one: be careful.
      found.sure->covariance *= 4;
      begin_anew(*found.sure);
      carried_ = *found.sure;
      ++restarts_;
      fit_ = 1;
      by_chance_ = false;
      return inner_->see(seen);
    }
  }
  if (++in_vain_ < (by_chance_ ? 2 : 1) * kInVain) return matches;
  begin_anew(carried_);
  return inner_->see(seen);
}

}  // namespace waymark
