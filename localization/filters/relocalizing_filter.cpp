// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/relocalizing_filter.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {
namespace {

constexpr int kWait = 5, kRestartInterval = 20;  // sets between calls of the finder, and between restarts
constexpr int kNearInterval = 3;                 // sets between searches of the poses that odometry allows
// ln of the expected number of chance poses: of matches that agree with odometry, and of a pose that is
// found.
constexpr double kRegained = -4.6, kCertain = -6.9;
// Below one half expected chance poses the filter's pose has a smaller expected squared error than
// odometry's.
constexpr double kMaxByChance = -0.69;
constexpr double kFade = 0.1, kSlowFade = 0.01;  // decay of the fit and the usual fit, per set
constexpr double kMinOfUsual = 0.5, kWell = 0.8;
// Fractions of the sightings explained beyond chance, or of the usual fit where the map lacks most objects.
constexpr double kByChance = 0.2, kExplained = 0.3, kByChanceOfUsual = 0.4, kExplainedOfUsual = 0.6;

double position_variance(const PoseEstimate& e) {
  return e.covariance(0, 0) + e.covariance(1, 1);
}

}  // namespace

RelocalizingFilter::RelocalizingFilter(const PoseEstimate& start, Factory factory, PoseFinder finder,
                                       ChanceFraction chance, FeatureScales scales, bool start_known,
                                       NearPoseFinder near)
    : make_filter_(std::move(factory)),
      finder_(std::move(finder)),
      near_(std::move(near)),
      chance_(std::move(chance)),
      inner_(make_filter_(start)),
      scales_(std::move(scales)),
      memory_(scales_),
      reliable_(start),
      located_(start_known),
      sets_since_query_(start_known ? 0 : kWait) {}

void RelocalizingFilter::predict(const BodyMotion& motion) {
  if (located_) inner_->predict(motion);
  memory_.predict(motion);
  evidence_.predict(motion);
  reliable_ = predict_other_pose(reliable_, motion);
  claims_.predict(motion);
}

bool RelocalizingFilter::fails() const {
  return chance_matches_ || inner_->status() == LocalizationStatus::lost || fit_ < kMinOfUsual * usual_fit_;
}

bool RelocalizingFilter::lost() const {
  return !located_ || !regained_ || fails();
}

// After a loss: do the matches since then prove the pose, or may they be chance?
void RelocalizingFilter::judge_matches() {
  if (regained_ && fails()) {
    regained_ = false;
    sets_since_search_ = kNearInterval, near_searches_ = 0;
    evidence_.clear();
  }
  if (regained_) {
    evidence_.clear();  // the matches of a filter that is not lost are not needed
    return;
  }
  const PoseEstimate here = inner_->estimate();
  const double log_false_alarms = evidence_.log_false_alarms(here, reliable_);
  regained_ = !fails() && (log_false_alarms < kRegained || !evidence_.is_possible());
  by_chance_ = !regained_ && evidence_.is_possible() &&
               (log_false_alarms > kMaxByChance || position_variance(here) > position_variance(reliable_));
}

// Searches the poses that odometry allows since the loss. Returns whether the filter restarted at one.
bool RelocalizingFilter::search_near(const SightingSet& seen) {
  if (regained_ || seen.sightings.empty() || ++sets_since_search_ < kNearInterval) return false;
  sets_since_search_ = 0;
  ++near_searches_;
  const PoseSearchResult found = memory_.find_near(near_, seen, reliable_);
  // Each search is one more chance of a false fix.
  if (!found.accepted || !(found.log_false_alarms + std::log(near_searches_) < kCertain)) return false;
  fit_ = std::max(fit_, usual_fit_);
  if (chance_matches_) explained_.clear();
  chance_matches_ = by_chance_ = false;
  regained_ = true;
  const bool moves =
      are_distinct(*found.accepted, inner_->estimate()) || inner_->status() == LocalizationStatus::lost;
  if (moves) {
    restart(*found.accepted);
    ++restarts_;
  }
  trust(inner_->estimate());
  return moves;
}

bool RelocalizingFilter::is_explained() const {
  return !chance_ ||
         (explained_.known() && explained_.value() > std::min(kExplained, kExplainedOfUsual * usual_fit_));
}

void RelocalizingFilter::restart(const PoseEstimate& at) {
  inner_ = make_filter_(at);
  unresolved_sets_ = sets_since_query_ = 0;
  explained_.clear();
  evidence_.clear();
}

// Restarts at the finder's pose if it is certain.
bool RelocalizingFilter::relocate(const SightingSet& seen) {
  const int wait = located_ ? kWait : search_interval(++sets_without_pose_);
  if (++sets_since_query_ < wait) return false;
  sets_since_query_ = 0;
  PoseSearchResult found = memory_.find(finder_, seen);
  // Odometry may have bent what is remembered. A robot that knows where it was has a better judge in it.
  if (!located_ && !found.accepted) found = finder_(seen);
  if (!found.accepted) return false;
  if (located_ && claims_.judge(*found.accepted, reliable_) == PoseClaims::Verdict::open) {
    memory_ = SightingMemory(scales_);
    return false;
  }
  restart(*found.accepted);
  trust(*found.accepted);
  ++restarts_;
  fit_ = 1;
  chance_matches_ = by_chance_ = false;
  located_ = regained_ = true;
  return true;
}

std::vector<Match> RelocalizingFilter::update(const SightingSet& seen) {
  memory_.add(seen);
  if (!located_ && !relocate(seen)) return std::vector<Match>(seen.sightings.size());
  const PoseEstimate before = inner_->estimate();
  std::vector<Match> matches = inner_->update(seen);
  const double fit = matched_fraction(matches);
  if (fit >= 0) fit_ += kFade * (fit - fit_);
  if (chance_ && fit >= 0) {
    const double chance = chance_(seen, inner_->estimate(), matches);
    explained_.add(fit, chance);
    if (near_) evidence_.add(seen, matches, chance, before, inner_->estimate());
    chance_matches_ =
        chance_matches_
            ? !is_explained()
            : explained_.known() && explained_.value() < std::min(kByChance, kByChanceOfUsual * usual_fit_);
  }
  if (near_ && located_) {
    judge_matches();
    if (search_near(seen)) return inner_->update(seen);
  }
  if (!lost()) {
    unresolved_sets_ = 0;
    if (fit >= 0) usual_fit_ += std::max(kSlowFade, 1.0 / ++usual_sets_) * (fit - usual_fit_);
    if (fit_ >= kWell * usual_fit_ && is_explained()) trust(inner_->estimate());
    return matches;
  }
  if (seen.sightings.empty()) return matches;
  if (relocate(seen)) return inner_->update(seen);
  if (++unresolved_sets_ < (chance_matches_ ? 2 : 1) * kRestartInterval ||
      (near_ && evidence_.is_possible() && !regained_ && !by_chance_))
    return matches;
  restart(reliable_);
  return inner_->update(seen);
}

}  // namespace waymark::localization
