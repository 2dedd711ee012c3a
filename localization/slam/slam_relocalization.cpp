// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/slam_relocalization.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "localization/filters/regain_evidence.hpp"
#include "localization/slam/ekf_slam.hpp"
#include "localization/slam/existence_log_odds.hpp"

namespace waymark::localization {
namespace {

constexpr double kFade = 0.1, kSlowFade = 0.01;  // decay of the fit and the usual fit, per set
constexpr double kLostFade = 0.002;              // decay of the usual fit while lost
constexpr double kConfident = 0.6;  // fraction of the usual fit above which the finder is not called
// Sets between two searches of the whole map and two checks of the pose: while searching, in doubt, else.
constexpr int kWait = 5, kDoubtInterval = 10, kRoutineInterval = 20, kCheckInDoubt = 3;
// Fraction of looks, or of that of the best bin: a landmark of such a bin should be seen.
constexpr double kExpectedDetection = 0.65, kOfBest = 0.95;
constexpr int kUnmatchedSets = 10;
constexpr int kKnownFor = 10;   // sets after which a landmark is known, and not yet out of sight
constexpr int kUsualSets = 20;  // before the usual fit is known
// Of the sightings, as in RelocalizingFilter: fraction of the usual, beyond chance, and that of the usual.
constexpr double kExplainedOfUsual = 0.5, kBeyondChance = 0.2, kBeyondChanceOfUsual = 0.4;
constexpr double kTrialProbable = 0.05, kTrialCertain = 1e-3;  // levels of significance of a trial
constexpr int kLongestTrial = 40;                              // sets

// Returns the probability of at least `a` of a + b tosses of a coin.
double sign_test(int a, int b) {
  return std::exp(log_binomial_tail(a, a + b, 0.5));
}

}  // namespace

double PoseTrial::chance_of_rival() const {
  return sign_test(for_rival, for_own);
}

double PoseTrial::chance_of_own() const {
  return sign_test(for_own, for_rival);
}

bool SlamRelocalization::lost() const {
  const bool in_doubt = sets_ >= kUsualSets && fit() <= kConfident * usual_;
  if (trial_ && ((in_doubt && trial_->by_finder) || trial_->chance_of_rival() < kTrialProbable)) return true;
  return sets_ >= kUsualSets && fit() < 0.4 * usual_ && !is_explained();
}

bool SlamRelocalization::is_explained() const {
  if (explained_sets_ < kUsualSets || explained_fit_ < kExplainedOfUsual * usual_explained_) return false;
  return !beyond_chance_.known() ||
         beyond_chance_.value() > std::min(kBeyondChance, kBeyondChanceOfUsual * usual_explained_);
}

void SlamRelocalization::learn(const SetEvidence& evidence) {
  found_.add(evidence.expected);
  if (!evidence.expected.empty()) {
    ++sets_;  // starts at a known pose, and learns the detection rate of the sensor
    const double fraction =
        static_cast<double>(std::ranges::count(evidence.expected, true, &ExpectedLook::is_found)) /
        static_cast<double>(evidence.expected.size());
    usual_ += std::max(lost() ? kLostFade : kSlowFade, 1.0 / sets_) * (fraction - usual_);
  }
  if (evidence.fit < 0) return;
  ++explained_sets_;
  explained_fit_ += std::max(kFade, 1.0 / explained_sets_) * (evidence.fit - explained_fit_);
  usual_explained_ +=
      std::max(lost() ? kLostFade : kSlowFade, 1.0 / explained_sets_) * (evidence.fit - usual_explained_);
  beyond_chance_.add(evidence.fit, evidence.chance);
}

SlamRelocalization::Verdict SlamRelocalization::decide() {
  ++trial_->sets;
  if (trial_->chance_of_rival() < kTrialCertain) {
    trial_.reset();
    found_.raise_to(usual_);
    return Verdict::rival;
  }
  const bool refuted = trial_->chance_of_own() < kTrialProbable;
  if (!refuted && trial_->sets < kLongestTrial) return Verdict::open;
  trial_.reset();
  if (refuted) found_.raise_to(usual_);
  return Verdict::own;
}

bool SlamRelocalization::is_confirmed(const SightingSet& seen, const PoseEstimate& here) {
  if (!check_) return false;
  const std::optional<PoseEstimate> checked = memory_.check(check_, seen, here);
  return checked && !are_distinct(*checked, here);
}

std::optional<PoseEstimate> SlamRelocalization::update(const SightingSet& seen, const SetEvidence& evidence,
                                                       const PoseEstimate& here) {
  memory_.add(seen);
  learn(evidence);
  if (seen.sightings.empty() || (trial_ && trial_->by_finder)) return {};
  unmatched_sets_ = evidence.matched > 0 ? 0 : unmatched_sets_ + 1;
  const bool searching = lost() || unmatched_sets_ >= kUnmatchedSets;
  const bool confident = !searching && fit() > kConfident * usual_;
  if (confident && is_explained()) claims_.trust();
  ++sets_since_query_;
  if (++sets_since_check_ >= (confident ? kRoutineInterval : kCheckInDoubt)) {
    sets_since_check_ = 0;
    if (is_confirmed(seen, here)) {
      found_.raise_to(usual_);  // it is where it thinks, whatever hides the landmarks
      claims_.trust();
      sets_since_query_ = 0;
      return {};
    }
  }
  if (sets_since_query_ < (searching ? kWait : confident ? kRoutineInterval : kDoubtInterval)) return {};
  sets_since_query_ = 0;
  PoseSearchResult answer = memory_.find(finder_, seen);
  if (!answer.accepted) return {};
  if (are_distinct(*answer.accepted, here)) {
    const bool in_map = unmatched_sets_ < kUnmatchedSets;  // a trial is fair
    if (in_map || claims_.judge(*answer.accepted, here) == PoseClaims::Verdict::accepted)
      return answer.accepted;
    memory_ = SightingMemory(scales_);
    return {};
  }
  found_.raise_to(usual_);
  claims_.trust();
  return {};
}

void EkfSlam::set_pose_finder(PoseFinder finder, PoseCheck check) {
  search_.emplace(std::move(finder), std::move(check), scales_);
  start_tracker(own_estimate());
}

void EkfSlam::start_tracker(const PoseEstimate& at) {
  if (map_.empty() || options_.identification.use_identities) return;
  MultiHypothesisOptions options;
  options.search.search_growth = 1;
  const LandmarkMatcher matcher(LandmarkWindow(map_), scales_, options_.identification);
  tracker_ = std::make_unique<MultiHypothesisFilter>(at, matcher, options);
  if (!chance_) chance_ = make_chance_fraction(matcher);
}

// Returns the pose of the sum of Gaussians if it is precise and contradicts this filter.
std::optional<PoseEstimate> EkfSlam::contradiction() const {
  if (!tracker_ || tracker_->status() == LocalizationStatus::lost) return {};
  const PoseEstimate at = tracker_->estimate();
  const bool differs = position_sd(at) < kPrecise && are_distinct(at, own_estimate());
  return differs ? std::optional(at) : std::nullopt;
}

// Returns whether the sum of Gaussians knows the position much better: it also uses the sightings that one
// Gaussian cannot identify.
bool EkfSlam::is_outdone() const {
  if (!tracker_ || tracker_->status() == LocalizationStatus::lost) return false;
  const double tracked = position_sd(tracker_->estimate());
  return tracked < kPrecise && position_sd(own_estimate()) > kOutdone * tracked;
}

LocalizationStatus EkfSlam::status() const {
  return search_ && search_->lost() ? LocalizationStatus::lost : LocalizationStatus::tracking;
}

void EkfSlam::check_relocalization(const SightingSet& seen, std::span<const SlamCandidate> near,
                                   const std::vector<bool>& found) {
  SetEvidence evidence = in_map_;
  const double min_detection = std::min(kExpectedDetection, kOfBest * missed_.best_detection());
  for (const SlamCandidate& candidate : near) {
    const std::size_t i = candidate.landmark;
    if (!landmarks_[i].was_mapped || landmarks_[i].gone) continue;
    const bool is_expected =
        candidate.is_expected && missed_.detection(look_at(seen, candidate, false)) >= min_detection;
    if (is_expected) evidence.expected.push_back({i, found[i]});
    evidence.matched += found[i];
  }
  remember(seen, near, found);
  if (rival_) compare_with_rival(seen);
  if (!rival_ && is_outdone()) restart(tracker_->estimate());
  std::optional<PoseEstimate> at = search_->update(seen, evidence, own_estimate());
  const bool by_finder = at.has_value();
  if (!at && !rival_) at = contradiction();
  if (at && is_contradicted(*at)) at.reset();
  if (at) {
    rival_ = std::make_unique<EkfSlam>(*at, map_, scales_, options_, visible_);
    search_->begin_trial(by_finder);
  }
  if (!rival_ && !search_->lost() && evidence.matched > 0) trusted_ = landmarks_.size();
}

void EkfSlam::remember(const SightingSet& seen, std::span<const SlamCandidate> near,
                       const std::vector<bool>& found) {
  int known = 0, expected = 0;
  for (const SlamCandidate& candidate : near) {
    const SlamLandmark& l = landmarks_[candidate.landmark];
    if (l.matches == 0 || sets_ - l.first_set < kKnownFor) continue;
    const bool is_found = found[candidate.landmark];
    known += is_found;
    expected += is_found || (candidate.is_in_view && sets_ - l.last_set <= kKnownFor);
  }
  past_.add(seen, own_estimate(), known, expected);
}

bool EkfSlam::is_contradicted(const PoseEstimate& rival) {
  if (!matcher_) return false;
  return past_.contradict(rival, own_estimate(), [&](const SightingSet& seen, const PoseEstimate& from) {
    std::vector<bool> explained;
    for (const Match& m : matcher_->identify(seen, from, matcher_->landmarks_near(seen, from)).matches)
      explained.push_back(m.verdict == Verdict::matched || m.verdict == Verdict::ambiguous);
    return explained;
  });
}

void EkfSlam::compare_with_rival(const SightingSet& seen) {
  rival_->update(seen);
  if (!are_distinct(rival_->own_estimate(), own_estimate())) {
    search_->end_trial();
    rival_.reset();
    return;
  }
  for (std::size_t k = 0; k < seen.sightings.size(); ++k)
    search_->trial()->add(is_of_map(k), rival_->is_of_map(k));
  const SlamRelocalization::Verdict verdict = search_->decide();
  if (verdict == SlamRelocalization::Verdict::open) return;
  if (verdict == SlamRelocalization::Verdict::rival) {
    restart(rival_->estimate());
    ++restarts_;
  }
  if (contradiction()) start_tracker(own_estimate());
  rival_.reset();
}

void EkfSlam::restart(const PoseEstimate& at) {
  past_.move(own_estimate().pose, at.pose);
  state_.focus(1e9);
  missed_.forget_views();
  SlamState fresh(at);
  landmark_by_slot_.clear();
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    SlamLandmark& l = landmarks_[i];
    if (l.line) l.line->pieces.clear();
    if (l.was_mapped) {  // as in the map: what was learnt while lost belongs to other landmarks
      set_as_mapped(l, map_[i]);
      l.log_odds = std::max(l.log_odds, log_odds(l.quality));
      l.gone = false, l.missed = 0;
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
      if (l.line) fresh.set_site(*l.slot, l.line->anchor, std::max(-l.line->from, l.line->to));
      landmark_by_slot_.resize(*l.slot + 1);
      landmark_by_slot_[*l.slot] = i;
    }
  }
  state_ = std::move(fresh);
  pending_ = {};
  centre_ = at.pose.at();
  focused_ = std::numeric_limits<double>::infinity();
}

}  // namespace waymark::localization
