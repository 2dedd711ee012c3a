// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/absolute_fix.hpp"
#include "localization/body_motion.hpp"
#include "localization/filters/explained_fraction.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Returns whether a sighting has a bearing. Ranges alone fit mirrored poses, too.
bool has_bearing(const SightingSet& seen);

/// Decides whether a filter without a given start has found the robot. Until then its covariance must cover
/// every position the robot may have.
/// - Particles gathered at one position are no proof: those elsewhere may have died early, and the filter
///   chose where most fits by chance. A robot at rest sees the same chance again and again.
/// - Found: a PoseFinder is certain of the position. Identified landmarks with bearings cannot fit by
///   chance: with them one mode for twenty sets, in which the map explains 0.35 of the sightings, is enough.
/// - No longer found: the map explains less than 0.2.
class Convergence {
 public:
  /// `prior`: the estimate before any sighting. `identities`: whether landmarks identify themselves.
  Convergence(const PoseEstimate& prior, bool identities) : prior_(prior), identities_(identities) {}

  void predict(const BodyMotion& motion) { prior_ = predict_other_pose(prior_, motion); }
  /// Bounds the prior by a measured position.
  void fix(const GnssFix& gnss);
  /// Adds a set of sightings: the fraction that fits, and the fraction that fits by chance. `unimodal`:
  /// the filter has one mode. `located`: a sighting has a bearing.
  void count(double fit, double chance, bool unimodal, bool located = true);
  /// Compares the filter's position with a certain one from a finder.
  void confirm(const PoseEstimate& sure, const PoseEstimate& here);
  /// Records that the filter restarts at a certain position.
  void accept() { explained_.clear(), found_ = true; }

  /// Resets the decision; called when the filter restarts.
  void reset() { explained_.clear(), found_ = false; }

  bool found() const { return found_; }
  /// Returns the filter's estimate; until the robot is found, with the covariance of the prior added.
  PoseEstimate inflate_covariance(PoseEstimate estimate) const;

 private:
  PoseEstimate prior_;
  ExplainedFraction explained_;
  bool identities_ = false, found_ = false;
};

}  // namespace waymark::localization
