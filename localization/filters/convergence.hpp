// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/absolute_fix.hpp"
#include "localization/body_motion.hpp"
#include "localization/filters/explained_fraction.hpp"
namespace waymark::localization {

/// Decides whether a filter without a given start has found the robot. Until then its covariance must cover
/// every position the robot may have.
/// - Particles gathered at one position are no proof: those elsewhere may have died early, and in a dense
///   map many sightings fit anywhere.
/// - Found: a PoseFinder confirms the position, or the map explains 0.35 of the sightings beyond chance.
/// - No longer found: the map explains less than 0.2.
class Convergence {
 public:
  /// `prior`: the estimate before any sighting.
  explicit Convergence(const PoseEstimate& prior) : prior_(prior) {}

  void predict(const BodyMotion& motion) { prior_ = predict_pose(prior_, motion); }
  /// Bounds the prior by a measured position.
  void fix(const GnssFix& gnss);
  /// Adds a set of sightings: the fraction that fits, and the fraction that fits by chance. `unimodal`:
  /// the filter has one mode.
  void count(double fit, double chance, bool unimodal);
  /// Compares the filter's position with a certain one from a finder.
  void confirm(const PoseEstimate& sure, const PoseEstimate& here);

  /// Resets the decision; called when the filter restarts.
  void reset() { explained_.clear(), found_ = false; }

  bool found() const { return found_; }
  /// Returns the filter's estimate; until the robot is found, with the covariance of the prior added.
  PoseEstimate inflate_covariance(PoseEstimate estimate) const;

 private:
  PoseEstimate prior_;
  ExplainedFraction explained_;
  bool found_ = false;
};

}  // namespace waymark::localization
