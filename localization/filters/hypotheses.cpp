// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/hypotheses.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "localization/filters/kalman.hpp"

namespace waymark {
namespace {

constexpr std::size_t kTogether = 3;  // sightings paired jointly; more are taken in turn

}  // namespace

void HypothesesOptions::describe(OptionVisitor& option) {
  option("hypotheses", most, {.help = "Most Gaussians kept", .min = 1, .max = 1e5});
  option("least_weight", least,
         {.help = "Weight, relative to the best, below which a Gaussian is dropped", .min = 0, .max = 1});
  option("merge", merge,
         {.help = "Squared Mahalanobis distance below which two Gaussians become one", .min = 0});
  option("split_yaw", split_yaw,
         {.help = "Standard deviation of yaw, radians, above which a Gaussian is split", .min = 0.01});
  option("lost_after", lost_after,
         {.help = "Sets of sightings in a row that fit nowhere before the filter searches", .min = 1});
  option("same_error", same_error,
         {.help = "Metres driven until the error of a landmark on the map counts as new; 0: at once",
          .min = 0,
          .max = 1e6});
  option("search_growth", search_growth,
         {.help = "Growth of the standard deviations per set while searching", .min = 1, .max = 10});
}

HypothesesFilter::HypothesesFilter(const PoseEstimate& start, LandmarkWindow map, FeatureScales scales,
                                   IdentificationOptions identification, HypothesesOptions options)
    : map_(std::move(map)),
      scales_(std::move(scales)),
      identification_(std::move(identification)),
      options_(options) {
  if (!start.pose.finite() || !start.covariance.allFinite())
    throw std::invalid_argument("the start of a filter must be finite");
  parts_.push_back({start, 1, {}});
}

void HypothesesFilter::move(const BodyMotion& motion) {
  for (Part& part : parts_)
    part.at = options_.unscented ? unscented_moved(part.at, motion) : moved(part.at, motion);
  driven_ += motion.step.at().norm();
}

void HypothesesFilter::expect_landmarks(const WeightOptions& view, LineOfSight visible) {
  if (view.expect_unseen) view_ = view;
  visible_ = std::move(visible);
}

double HypothesesFilter::alike(LandmarkKey key) const {
  const auto used = uses_.find(key);
  if (used == uses_.end() || !(options_.same_error > 0)) return 0;
  return used->second.count * std::exp((used->second.driven - driven_) / options_.same_error);
}

// The Gaussians of a set that was paired one way are told apart by the landmarks they should have seen too.
void HypothesesFilter::miss(const SightingSet& seen, const LandmarkGrid& map) {
  SightingScore score(seen, map, scales_, *view_, identification_.use_identities);
  std::vector<double> logs;
  for (const Part& part : parts_) {
    score.hide(hidden_landmarks(part.at.pose * seen.robot_from_sensor, map, view_->view_range, visible_));
    std::vector<std::uint32_t> matched;
    for (const int l : part.choice)
      if (l >= 0) matched.push_back(static_cast<std::uint32_t>(l));
    logs.push_back(std::log(part.weight) + score.unseen(part.at.pose, matched));
  }
  const std::vector<double> weights = normalised(logs);
  for (std::size_t i = 0; i < parts_.size(); ++i) parts_[i].weight = weights[i];
}

PoseEstimate HypothesesFilter::updated_by(const Part& part, const SightingSet& some,
                                          const std::vector<Candidates>& sets, const JointHypothesis& how,
                                          const LandmarkGrid& map) const {
  PoseEstimate at = part.at;
  JointEvidence evidence;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (how.choice[i] < 0) continue;
    MapLandmark landmark = map[sets[i].pairings[static_cast<std::size_t>(how.choice[i])].landmark];
    landmark.covariance *= 1 + alike(landmark.key) / 2;
    const double trust = trust_in(landmark, identification_);
    const SeenLandmark& seen = some.sightings[i];
    if (options_.unscented)
      at = unscented_updated(at, seen, some.robot_from_sensor, landmark, trust);
    else
      evidence += evidence_of(seen, expect(part.at.pose, some.robot_from_sensor, landmark.at),
                              landmark.covariance, trust);
  }
  if (!options_.unscented) at = updated(part.at, evidence);
  return at;
}

void HypothesesFilter::see_some(const SightingSet& some, const LandmarkGrid& map) {
  std::vector<Part> next;
  std::vector<double> logs;
  for (const Part& part : parts_) {
    std::vector<Candidates> sets;
    for (const SeenLandmark& s : some.sightings) {
      sets.push_back(candidates(s, some.robot_from_sensor, part.at, map, scales_, identification_));
      std::erase_if(sets.back().pairings, [&](const CandidatePair& p) {
        return std::ranges::find(part.choice, static_cast<int>(p.landmark)) != part.choice.end();
      });
    }
    const auto found = joint_hypotheses(sets, some, map, part.at.covariance, identification_);
    if (!found) continue;
    for (const JointHypothesis& h : *found) {
      Part& after = next.emplace_back(part);
      after.at = updated_by(part, some, sets, h, map);
      for (std::size_t i = 0; i < sets.size(); ++i)
        after.choice.push_back(
            h.choice[i] < 0
                ? -1
                : static_cast<int>(sets[i].pairings[static_cast<std::size_t>(h.choice[i])].landmark));
      logs.push_back(std::log(part.weight) + h.log_weight);
    }
  }
  if (next.empty()) {
    for (Part& part : parts_) part.choice.resize(part.choice.size() + some.sightings.size(), -1);
    return;
  }
  const double best = std::ranges::max(logs);
  for (std::size_t i = 0; i < next.size(); ++i) next[i].weight = std::exp(logs[i] - best);
  parts_ = std::move(next);
  prune();
}

std::vector<Match> HypothesesFilter::see(const SightingSet& seen) {
  const PoseEstimate before = estimate();
  double farthest = 0;
  for (const SeenLandmark& s : seen.sightings)
    if (s.sound())
      farthest = std::max(farthest, s.range ? *s.range + 6 * s.range_sd : identification_.bearing_reach);
  if (view_) farthest = std::max(farthest, view_->view_range);
  const double width = std::sqrt(before.covariance(0, 0) + before.covariance(1, 1));
  const LandmarkGrid& map = map_.around(before.pose.at(), farthest + 6 * width + 1);

  std::vector<Match> matches(seen.sightings.size());
  SightingSet some{seen.robot_from_sensor, {}};
  std::vector<std::size_t> places;  // of the sightings in `some`, and of those before
  split();
  for (Part& part : parts_) part.choice.clear();
  const auto flush = [&] {
    if (!some.sightings.empty()) see_some(some, map);
    some.sightings.clear();
  };
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const SeenLandmark& s = seen.sightings[i];
    const bool named = identification_.use_identities && s.identity;
    matches[i].verdict = !s.sound()                                                   ? Verdict::unsound
                         : s.type == kNoSuchType || (named && !map.find(*s.identity)) ? Verdict::unknown_type
                                                                                      : Verdict::matched;
    if (matches[i].verdict != Verdict::matched) continue;
    places.push_back(i);
    some.sightings.push_back(s);
    if (some.sightings.size() == kTogether) flush();
  }
  flush();
  if (view_) miss(seen, map);

  bool fits = places.empty();
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::map<int, double> weight;
    for (const Part& part : parts_) weight[part.choice[k]] += part.weight;
    const auto best = std::ranges::max_element(weight, {}, [](const auto& w) { return w.second; });
    Match& match = matches[places[k]];
    match.probability = best->second;
    fits = fits || best->first >= 0;
    if (best->first < 0) {
      match.verdict = best->second > identification_.certainty ? Verdict::too_far : Verdict::ambiguous;
    } else if (best->second < identification_.certainty) {
      match.verdict = Verdict::ambiguous;
    } else {
      match.pairing.landmark = static_cast<std::uint32_t>(best->first);
      const MapLandmark& landmark = map[match.pairing.landmark];
      match.key = landmark.key;
      const SeenLandmark& s = seen.sightings[places[k]];
      match.pairing.evidence = evidence_of(s, expect(before.pose, seen.robot_from_sensor, landmark.at),
                                           landmark.covariance, trust_in(landmark, identification_));
      uses_[match.key] = {1 + alike(match.key), driven_};
    }
  }
  // What was paired how no longer matters: the same place is the same hypothesis.
  for (Part& part : parts_) part.choice.clear();
  prune();
  missed_ = fits ? 0 : missed_ + 1;
  if (missed_ >= options_.lost_after && options_.search_growth > 1) widen(options_.search_growth);
  return matches;
}

template <class Fix>
bool HypothesesFilter::take(const Fix& measured, int rows) {
  FixGate& gate = rows == 2 ? gnss_ : heading_;
  const auto least = [&] {
    double squares = 1e300;
    for (const Part& part : parts_) squares = std::min(squares, updated(part.at, measured).squares);
    return squares;
  };
  if (!gate.pass(least(), rows)) return false;
  if (gate.overruled())
    for (int i = 0; i < 40 && least() > 4; ++i) widen(2);
  std::vector<double> logs;
  for (Part& part : parts_) {
    const FixUpdate update = updated(part.at, measured);
    part.at = update.estimate;
    logs.push_back(std::log(part.weight) + update.log_density);
  }
  const double best = std::ranges::max(logs);
  for (std::size_t i = 0; i < parts_.size(); ++i) parts_[i].weight = std::exp(logs[i] - best);
  prune();
  return true;
}
template bool HypothesesFilter::take(const GnssFix&, int);
template bool HypothesesFilter::take(const HeadingFix&, int);

}  // namespace waymark
