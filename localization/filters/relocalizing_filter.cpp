// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/relocalizing_filter.hpp"

#include <algorithm>

namespace waymark::localization {
namespace {

constexpr int kWait = 5, kRestartInterval = 20;  // sets between calls of the finder, and between restarts
constexpr double kFade = 0.1, kSlowFade = 0.01;  // decay of the fit and the usual fit, per set
constexpr double kMinOfUsual = 0.5, kWell = 0.8;
// Fractions of the sightings explained beyond chance, or of the usual fit where the map lacks most objects.
constexpr double kByChance = 0.2, kExplained = 0.3, kByChanceOfUsual = 0.4, kExplainedOfUsual = 0.6;

}  // namespace

RelocalizingFilter::RelocalizingFilter(const PoseEstimate& start, Factory factory, PoseFinder finder,
                                       ChanceFraction chance, FeatureScales scales, bool start_known)
    : make_filter_(std::move(factory)),
      finder_(std::move(finder)),
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
  reliable_ = predict_other_pose(reliable_, motion);
  claims_.predict(motion);
}

bool RelocalizingFilter::lost() const {
  return !located_ || chance_matches_ || inner_->status() == LocalizationStatus::lost ||
         fit_ < kMinOfUsual * usual_fit_;
}

bool RelocalizingFilter::is_explained() const {
  return !chance_ ||
         (explained_.known() && explained_.value() > std::min(kExplained, kExplainedOfUsual * usual_fit_));
}

void RelocalizingFilter::restart(const PoseEstimate& at) {
  inner_ = make_filter_(at);
  unresolved_sets_ = sets_since_query_ = 0;
  explained_.clear();
}

// Restarts at the finder's pose if it is certain.
bool RelocalizingFilter::relocate(const SightingSet& seen) {
  if (++sets_since_query_ < kWait) return false;
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
  chance_matches_ = false;
  located_ = true;
  return true;
}

std::vector<Match> RelocalizingFilter::update(const SightingSet& seen) {
  memory_.add(seen);
  if (!located_ && !relocate(seen)) return std::vector<Match>(seen.sightings.size());
  std::vector<Match> matches = inner_->update(seen);
  const double fit = matched_fraction(matches);
  if (fit >= 0) fit_ += kFade * (fit - fit_);
  if (chance_ && fit >= 0) {
    explained_.add(fit, chance_(seen, inner_->estimate(), matches));
    chance_matches_ =
        chance_matches_
            ? !is_explained()
            : explained_.known() && explained_.value() < std::min(kByChance, kByChanceOfUsual * usual_fit_);
  }
  if (!lost()) {
    unresolved_sets_ = 0;
    if (fit >= 0) usual_fit_ += std::max(kSlowFade, 1.0 / ++usual_sets_) * (fit - usual_fit_);
    if (fit_ >= kWell * usual_fit_ && is_explained()) trust(inner_->estimate());
    return matches;
  }
  if (seen.sightings.empty()) return matches;
  if (relocate(seen)) return inner_->update(seen);
  if (++unresolved_sets_ < (chance_matches_ ? 2 : 1) * kRestartInterval) return matches;
  restart(reliable_);
  return inner_->update(seen);
}

}  // namespace waymark::localization
