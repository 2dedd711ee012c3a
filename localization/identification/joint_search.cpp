// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/joint_search.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "localization/chi_square.hpp"

namespace waymark::localization {
namespace {

constexpr double kMaxLoss = 14;  // ln of 1e6: hypotheses less probable than the best by this are omitted
const double kLogTurn = std::log(2 * std::numbers::pi);

class CompatibilitySearch {
 public:
  CompatibilitySearch(std::span<const Candidates> sets, const Eigen::Matrix3d& pose,
                      const IdentificationOptions& options)
      : sets_(sets), pose_(pose), left_(options.node_limit), choice_(sets.size(), -1) {
    int max_rows = 0;
    for (const Candidates& set : sets) {
      int rows = 0;
      for (const CandidatePair& p : set.pairings) rows = std::max(rows, p.evidence.rows);
      max_rows += rows;
    }
    for (int rows = 1; rows <= max_rows; ++rows) gates_.push_back(chi_square_quantile(options.gate, rows));
  }

  std::optional<JointChoice> best() {
    best_choice_ = choice_;
    descend(0, {}, 0);
    if (left_ < 0) return {};
    return best_choice_;
  }

 private:
  void descend(std::size_t depth, const JointEvidence& so_far, int pairs) {
    if (--left_ < 0) return;
    const double squares = so_far.rows ? joint_distance(so_far, pose_).squares : 0;
    if (so_far.rows && squares > gates_[static_cast<std::size_t>(so_far.rows) - 1]) return;
    if (depth == sets_.size()) {
      if (pairs > best_pairs_ || (pairs == best_pairs_ && squares < best_squares_)) {
        best_pairs_ = pairs;
        best_squares_ = squares;
        best_choice_ = choice_;
      }
      return;
    }
    if (pairs + static_cast<int>(sets_.size() - depth) < best_pairs_) return;
    const auto& pairings = sets_[depth].pairings;
    for (std::size_t i = 0; i < pairings.size(); ++i) {
      if (taken(depth, pairings[i].landmark)) continue;
      choice_[depth] = static_cast<int>(i);
      descend(depth + 1, so_far + pairings[i].evidence, pairs + 1);
    }
    choice_[depth] = -1;
    descend(depth + 1, so_far, pairs);
  }

  bool taken(std::size_t depth, std::uint32_t landmark) const {
    for (std::size_t d = 0; d < depth; ++d)
      if (choice_[d] >= 0 && sets_[d].pairings[static_cast<std::size_t>(choice_[d])].landmark == landmark)
        return true;
    return false;
  }

  std::span<const Candidates> sets_;
  Eigen::Matrix3d pose_;
  std::int64_t left_;
  JointChoice choice_, best_choice_;
  std::vector<double> gates_;
  int best_pairs_ = -1;
  double best_squares_ = 0;
};

class HypothesisList {
 public:
  HypothesisList(std::span<const Candidates> sets, const SightingSet& seen, const LandmarkGrid& map,
                 const Eigen::Matrix3d& pose, const IdentificationOptions& options)
      : sets_(sets), seen_(seen), map_(map), pose_(pose), options_(options), left_(options.node_limit) {}

  bool list() {
    JointChoice none(sets_.size(), -1);
    max_remaining_.assign(sets_.size() + 1, 0);
    for (std::size_t i = sets_.size(); i-- > 0;) {
      double max_value = unpaired(i);
      for (const CandidatePair& p : sets_[i].pairings)
        max_value = std::max(max_value, paired(i, p) - (p.evidence.log_det + p.evidence.rows * kLogTurn) / 2);
      max_remaining_[i] = max_remaining_[i + 1] + max_value;
    }
    descend(0, {}, 0, none);
    return left_ >= 0;
  }
  std::vector<JointHypothesis> found;

 private:
  // Branch and bound: no remaining sighting can be denser than the peak of its sensor's noise. Prunes what
  // cannot come within kMaxLoss of the best; it would be omitted anyway.
  void descend(std::size_t depth, const JointEvidence& so_far, double log_weight, JointChoice& choice) {
    if (--left_ < 0) return;
    double value = log_weight;
    if (so_far.rows) {
      const JointDistance d = joint_distance(so_far, pose_);
      value -= (d.squares + d.log_det + so_far.rows * kLogTurn) / 2;
    }
    if (value + max_remaining_[depth] < best_ - kMaxLoss) return;
    if (depth == sets_.size()) {
      found.push_back({choice, so_far, value});
      best_ = std::max(best_, value);
      return;
    }
    const auto& pairings = sets_[depth].pairings;
    for (std::size_t i = 0; i < pairings.size(); ++i) {
      if (taken(depth, pairings[i].landmark, choice)) continue;
      choice[depth] = static_cast<int>(i);
      descend(depth + 1, so_far + pairings[i].evidence, log_weight + paired(depth, pairings[i]), choice);
    }
    choice[depth] = -1;
    descend(depth + 1, so_far, log_weight + unpaired(depth), choice);
  }

  double paired(std::size_t sighting, const CandidatePair& p) const {
    return std::log(existence_prior(map_[p.landmark], options_) * seen_.sightings[sighting].confidence) -
           p.features / 2;
  }
  // A sighting without range is clutter anywhere along its bearing, one without bearing on its circle.
  double unpaired(std::size_t sighting) const {
    const auto& pairings = sets_[sighting].pairings;
    return std::log(options_.clutter_of(seen_.sightings[sighting])) -
           0.5 * (pairings.empty() ? 0 : typical_features(pairings));
  }

  // Returns the average cost of the features of a right pairing, so that unpaired sightings are comparable.
  static double typical_features(const std::vector<CandidatePair>& pairings) {
    return pairings[0].feature_count;
  }

  bool taken(std::size_t depth, std::uint32_t landmark, const JointChoice& choice) const {
    for (std::size_t d = 0; d < depth; ++d)
      if (choice[d] >= 0 && sets_[d].pairings[static_cast<std::size_t>(choice[d])].landmark == landmark)
        return true;
    return false;
  }

  std::span<const Candidates> sets_;
  const SightingSet& seen_;
  const LandmarkGrid& map_;
  Eigen::Matrix3d pose_;
  const IdentificationOptions& options_;
  std::int64_t left_;
  std::vector<double> max_remaining_;  // by depth: the most that the remaining sightings can add
  double best_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

std::optional<JointChoice> joint_compatibility(std::span<const Candidates> sets, const Eigen::Matrix3d& pose,
                                               const IdentificationOptions& options) {
  return CompatibilitySearch(sets, pose, options).best();
}

std::optional<std::vector<JointHypothesis>> joint_hypotheses(std::span<const Candidates> sets,
                                                             const SightingSet& seen, const LandmarkGrid& map,
                                                             const Eigen::Matrix3d& pose,
                                                             const IdentificationOptions& options) {
  HypothesisList all(sets, seen, map, pose, options);
  if (!all.list()) return {};
  for (JointHypothesis& h : all.found) h.log_weight = h.probability;
  std::ranges::stable_sort(all.found, std::greater<>{}, &JointHypothesis::probability);
  const double best = all.found[0].probability;
  double total = 0;
  std::erase_if(all.found, [&](const JointHypothesis& h) { return h.probability < best - kMaxLoss; });
  for (JointHypothesis& h : all.found) total += h.probability = std::exp(h.probability - best);
  for (JointHypothesis& h : all.found) h.probability /= total;
  return std::move(all.found);
}

}  // namespace waymark::localization
