// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/multi_hypothesis_filter.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "localization/filters/kalman.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kJointSightings = 3;  // sightings associated jointly; further ones follow in turn
constexpr double kNewEvidence = 15;         // metres driven until an object seen again is new evidence

}  // namespace

void MultiHypothesisOptions::describe(OptionVisitor& option) {
  option("hypotheses", max_hypotheses, {.help = "Largest number of Gaussians", .min = 1, .max = 1e5});
  option("min_weight", min_weight,
         {.help = "Weight, relative to the best, below which a Gaussian is dropped",
          .min = 0,
          .max = 1,
          .formerly = "least_weight"});
  option("merge", merge,
         {.help = "Squared Mahalanobis distance below which two Gaussians are merged", .min = 0});
  option("split_yaw", split_yaw,
         {.help = "Standard deviation of yaw, radians, above which a Gaussian is split", .min = 0.01});
  option(
      "error_correlation_distance", error_correlation_distance,
      {.help = "Metres driven until the map error of a landmark not seen meanwhile counts as new; 0: at once",
       .min = 0,
       .max = 1e6,
       .formerly = "same_error"});
}

MultiHypothesisFilter::MultiHypothesisFilter(const PoseEstimate& start, LandmarkMatcher matcher,
                                             MultiHypothesisOptions options)
    : matcher_(std::move(matcher)), options_(options) {
  if (!start.pose.finite() || !start.covariance.allFinite())
    throw std::invalid_argument("the start of a filter must be finite");
  components_.push_back({start, MapErrors(options_.error_correlation_distance), 1, {}, {}});
}

void MultiHypothesisFilter::predict(const BodyMotion& motion) {
  for (Component& component : components_) {
    component.errors.predict(component.at.pose, motion.step);
    component.at =
        options_.unscented ? ukf_predict(component.at, motion) : predict_pose(component.at, motion);
  }
  follower_.predict(motion);
}

void MultiHypothesisFilter::expect_landmarks(const WeightOptions& view, LineOfSight visible) {
  if (view.expect_unseen) view_ = view;
  visible_ = std::move(visible);
}

// Weights the Gaussians of a set by the landmarks they expect and that were not seen.
void MultiHypothesisFilter::weigh_unseen(const SightingSet& seen, const LandmarkGrid& map) {
  SightingScore score(seen, map, matcher_.scales(), *view_, matcher_.options());
  std::vector<double> logs;
  for (const Component& component : components_) {
    score.hide(
        hidden_landmarks(component.at.pose * seen.robot_from_sensor, map, view_->view_range, visible_));
    std::vector<std::uint32_t> matched;
    for (const int l : component.choice)
      if (l >= 0) matched.push_back(static_cast<std::uint32_t>(l));
    logs.push_back(std::log(component.weight) + score.unseen(component.at.pose, matched));
  }
  const std::vector<double> weights = normalise_log_weights(logs);
  for (std::size_t i = 0; i < components_.size(); ++i) components_[i].weight = weights[i];
}

void MultiHypothesisFilter::update_component(Component& component, const SightingSet& some,
                                             const std::vector<Candidates>& sets, const JointHypothesis& how,
                                             const LandmarkGrid& map) const {
  std::vector<AngleFix> fixes;
  const double yaw = component.at.pose.yaw;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (how.choice[i] < 0) continue;
    const MapLandmark& landmark = map[sets[i].pairings[static_cast<std::size_t>(how.choice[i])].landmark];
    const SeenLandmark& seen = some.sightings[i];
    component.at = component.errors.correct(component.at, seen, some.robot_from_sensor, landmark,
                                            noise_divisor(landmark, matcher_.options()), options_.unscented);
    for (const AngleFix& fix : headings_from_angles(seen, some.robot_from_sensor, landmark, yaw,
                                                    matcher_.scales(), matcher_.options()))
      fixes.push_back(fix);
  }
  for (const AngleFix& fix : fixes) {
    const PoseEstimate after = update_pose(component.at, fix.heading).estimate;
    component.errors.follow(component.at, after);
    component.at = after;
  }
}

namespace {

/// Returns the decisions of a joint hypothesis as landmarks.
std::vector<std::optional<LandmarkKey>> decisions(const JointChoice& choice,
                                                  const std::vector<Candidates>& sets,
                                                  const LandmarkGrid& map) {
  std::vector<std::optional<LandmarkKey>> keys(choice.size());
  for (std::size_t i = 0; i < choice.size(); ++i)
    if (choice[i] >= 0) keys[i] = map[sets[i].pairings[static_cast<std::size_t>(choice[i])].landmark].key;
  return keys;
}

/// Weighs the joint hypotheses of objects that are followed. What was decided about them before is no new
/// evidence. It counts by the fraction that the metres driven since make new; a robot that
/// stands hardly revises it.
class FollowedDecision {
 public:
  FollowedDecision(const std::map<int, std::optional<LandmarkKey>>& of_object,
                   std::span<const SightingFollower::Seen> objects, const std::vector<JointHypothesis>& found,
                   const std::vector<Candidates>& sets, const LandmarkGrid& map) {
    for (const SightingFollower::Seen& object : objects) {
      const auto known = of_object.find(object.object);
      if (object.metres < 0 || known == of_object.end()) return;
      earlier_.push_back(known->second);
      fresh_ = std::min(fresh_, 1 - std::exp(-object.metres / kNewEvidence));
    }
    for (const JointHypothesis& h : found)
      if (decisions(h.choice, sets, map) == earlier_) agreeing_ = h.log_weight;
  }

  double log_weight(const JointHypothesis& h, const std::vector<std::optional<LandmarkKey>>& keys) const {
    if (!agreeing_) return h.log_weight;
    const double gain = h.log_weight - *agreeing_;
    const bool revised = keys != earlier_ && fresh_ < kStanding;
    return fresh_ * *agreeing_ + (gain > 0 ? fresh_ * gain : gain) + (revised ? std::log(1e-4) : 0);
  }

 private:
  static constexpr double kStanding = 1e-3 / kNewEvidence;  // a millimetre: the robot stands
  std::vector<std::optional<LandmarkKey>> earlier_;
  double fresh_ = 1;
  std::optional<double> agreeing_;  // log weight of the earlier decision
};

}  // namespace

void MultiHypothesisFilter::update_jointly(const SightingSet& some,
                                           std::span<const SightingFollower::Seen> objects,
                                           const LandmarkGrid& map) {
  std::vector<Component> next;
  std::vector<double> logs;
  for (Component& component : components_) {
    std::vector<Candidates> sets;
    for (const SeenLandmark& s : some.sightings) {
      sets.push_back(matcher_.candidates(s, some.robot_from_sensor, component.at, map));
      std::erase_if(sets.back().pairings, [&](const CandidatePair& p) {
        return std::ranges::find(component.choice, static_cast<int>(p.landmark)) != component.choice.end();
      });
    }
    const auto found = joint_hypotheses(sets, some, map, component.at.covariance, matcher_.options());
    if (!found) continue;
    const FollowedDecision earlier(component.of_object, objects, *found, sets, map);
    const double log_weight = std::log(component.weight);
    for (const JointHypothesis& h : *found) {
      Component& after = next.emplace_back(&h == &found->back() ? std::move(component) : component);
      const auto keys = decisions(h.choice, sets, map);
      for (std::size_t i = 0; i < keys.size(); ++i) after.of_object[objects[i].object] = keys[i];
      update_component(after, some, sets, h, map);
      for (std::size_t i = 0; i < sets.size(); ++i)
        after.choice.push_back(
            h.choice[i] < 0
                ? -1
                : static_cast<int>(sets[i].pairings[static_cast<std::size_t>(h.choice[i])].landmark));
      logs.push_back(log_weight + earlier.log_weight(h, keys));
    }
  }
  if (next.empty()) {
    for (Component& component : components_)
      component.choice.resize(component.choice.size() + some.sightings.size(), -1);
    return;
  }
  const double best = std::ranges::max(logs);
  for (std::size_t i = 0; i < next.size(); ++i) next[i].weight = std::exp(logs[i] - best);
  components_ = std::move(next);
  prune();
}

std::vector<Match> MultiHypothesisFilter::update(const SightingSet& seen) {
  const PoseEstimate before = estimate();
  const IdentificationOptions& identification = matcher_.options();
  matcher_.observe(seen);
  const LandmarkGrid& map = matcher_.landmarks_near(seen, before, view_ ? view_->view_range : 0);

  std::vector<Match> matches(seen.sightings.size());
  SightingSet some{seen.robot_from_sensor, {}};
  std::vector<std::size_t> places;  // indices of the sightings in `some`, and of those before
  const std::vector<SightingFollower::Seen> objects = follower_.follow(seen);
  std::vector<SightingFollower::Seen> some_objects;
  split();
  for (Component& component : components_) {
    component.choice.clear();
    std::erase_if(component.of_object, [&](const auto& of) {
      return std::ranges::none_of(objects, [&](const auto& o) { return o.object == of.first; });
    });
  }
  const auto flush = [&] {
    if (!some.sightings.empty()) update_jointly(some, some_objects, map);
    some.sightings.clear(), some_objects.clear();
  };
  // Objects that are followed come first, in sets of their own.
  std::vector<std::size_t> order;
  for (const bool followed : {true, false})
    for (std::size_t i = 0; i < matches.size(); ++i)
      if ((objects[i].metres >= 0) == followed) order.push_back(i);
  for (const std::size_t i : order) {
    const SeenLandmark& s = seen.sightings[i];
    if (!some.sightings.empty() && (objects[i].metres >= 0) != (some_objects.back().metres >= 0)) flush();
    const bool named = identification.use_identities && s.identity;
    const bool is_known = s.type != kNoSuchType &&
                          (named ? map.find(*s.identity).has_value() : identification.may_be_mapped(s));
    matches[i].verdict = !s.is_valid() ? Verdict::unsound
                         : is_known    ? Verdict::matched
                                       : Verdict::unknown_type;
    if (matches[i].verdict != Verdict::matched) continue;
    places.push_back(i);
    some.sightings.push_back(s);
    some_objects.push_back(objects[i]);
    if (some.sightings.size() == kJointSightings) flush();
  }
  flush();
  if (view_) weigh_unseen(seen, map);

  bool fits = places.empty();
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::map<int, double> weight;
    for (const Component& component : components_) weight[component.choice[k]] += component.weight;
    const auto best = std::ranges::max_element(weight, {}, [](const auto& w) { return w.second; });
    Match& match = matches[places[k]];
    match.probability = best->second;
    match.unmapped = weight.contains(-1) ? weight.at(-1) : 0;
    fits = fits || best->first >= 0;
    const double certainty = identification.required_certainty(seen.sightings[places[k]]);
    if (best->first < 0) {
      match.verdict = best->second > certainty ? Verdict::too_far : Verdict::ambiguous;
    } else if (certainty_of(seen.sightings[places[k]], best->second, match.unmapped) < certainty) {
      match.verdict = Verdict::ambiguous;
    } else {
      match.pairing.landmark = static_cast<std::uint32_t>(best->first);
      const MapLandmark& landmark = map[match.pairing.landmark];
      name_landmark(match, landmark);
      const SeenLandmark& s = seen.sightings[places[k]];
      match.pairing.evidence = evidence_of(s, expect(before.pose, seen.robot_from_sensor, s, landmark),
                                           landmark.covariance, noise_divisor(landmark, identification));
    }
  }
  matcher_.learn(matches, seen, before, map);
  // Merges hypotheses of one pose, whatever their associations.
  for (Component& component : components_) component.choice.clear();
  prune();
  missed_ = fits ? 0 : missed_ + 1;
  if (missed_ >= options_.search.lost_after && options_.search.search_growth > 1)
    widen(options_.search.search_growth);
  return matches;
}

template <class Fix>
bool MultiHypothesisFilter::apply_fix(const Fix& measured, int rows) {
  FixGate& gate = rows == 2 ? gnss_ : heading_;
  const auto min_squares = [&] {
    double squares = 1e300;
    for (const Component& component : components_)
      squares = std::min(squares, update_pose(component.at, measured).squares);
    return squares;
  };
  if (!gate.pass(min_squares(), rows)) return false;
  if (gate.was_forced())
    for (int i = 0; i < 40 && min_squares() > 4; ++i) widen(2);
  std::vector<double> logs;
  for (Component& component : components_) {
    const FixUpdate update = update_pose(component.at, measured);
    component.errors.follow(component.at, update.estimate);
    component.at = update.estimate;
    logs.push_back(std::log(component.weight) + update.log_density);
  }
  const double best = std::ranges::max(logs);
  for (std::size_t i = 0; i < components_.size(); ++i) components_[i].weight = std::exp(logs[i] - best);
  prune();
  return true;
}
template bool MultiHypothesisFilter::apply_fix(const GnssFix&, int);
template bool MultiHypothesisFilter::apply_fix(const HeadingFix&, int);

}  // namespace waymark::localization
