// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include "localization/body_motion.hpp"
#include "localization/identification/identification.hpp"
#include "localization/identification/sighting_follower.hpp"
namespace waymark::localization {

/// Evidence that a filter which was lost knows its pose again: an a contrario test (Desolneux, Moisan & Morel
/// 2000) of the objects that it matched since.
/// - A filter that may be anywhere in a wide prior chooses the pose where most fits. Of all poses that the
///   prior allows, one fits well by chance; that a matched fraction is above that of one wrong pose is no
///   proof.
/// - An object counts once, however often it was seen, and so does a landmark.
class RegainEvidence {
 public:
  void predict(const BodyMotion& motion) { follower_.predict(motion); }
  /// Adds the matches of a set, and the fraction of its sightings that matched at a wrong pose; < 0: none.
  /// `before`, `after`: estimates before and after the set. If one of them is less precise than the
  /// sightings, anything fits, which is no evidence: particles that fit nothing spread out within a set.
  void add(const SightingSet& seen, std::span<const Match> matches, double chance, const PoseEstimate& before,
           const PoseEstimate& after);
  /// Forgets the objects, not the rate of chance matches: the filter has another pose.
  void clear() { objects_.clear(), only_positions_ = true; }
  /// Returns whether all matches are of sightings with a position. Lines and bearings are not counted as
  /// objects.
  bool is_possible() const { return only_positions_; }
  /// Returns ln of the expected number of distinguishable poses of the prior that match as many of the
  /// objects by chance. `at`: estimate of the filter.
  double log_false_alarms(const PoseEstimate& at, const PoseEstimate& prior) const;

 private:
  SightingFollower follower_;
  std::map<int, std::optional<LandmarkKey>> objects_;  // landmark that each was matched with last
  bool only_positions_ = true;
  double by_chance_ = 0, compared_ = 0;  // sightings at wrong poses, over about a hundred sets
};

/// Returns ln of the probability that at least `hits` of `trials` independent events of probability `p`
/// occur. O(trials).
double log_binomial_tail(int hits, int trials, double p);

}  // namespace waymark::localization
