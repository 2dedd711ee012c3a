// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/absolute_fix.hpp"
#include "localization/body_motion.hpp"
#include "localization/identification/identification.hpp"
namespace waymark::localization {

/// Status of a localizer.
enum class LocalizationStatus {
  tracking,       ///< sightings agree with the map, or there were none
  lost,           ///< all sightings of the last sets were rejected; it is searching
  uninitialized,  ///< no start was given and no landmark was seen yet
};

/// A method that tracks the pose of a robot. Predictions and updates are given in the order of time.
class Localizer {
 public:
  virtual ~Localizer() = default;
  /// Predicts the pose after a motion.
  virtual void predict(const BodyMotion& motion) = 0;
  /// Updates the pose with the sightings of one sensor at this moment. Returns one match per sighting.
  virtual std::vector<Match> update(const SightingSet& seen) = 0;
  /// Updates the pose with an absolute position or heading. Returns false if the fix was not used: the
  /// method does not support fixes, or the fix failed the gate.
  virtual bool fix(const GnssFix&) { return false; }
  virtual bool fix(const HeadingFix&) { return false; }
  /// Returns the current estimate; always finite.
  virtual PoseEstimate estimate() const = 0;
  /// Returns the pose with the covariance by which the method weighs measurements; that of its errors may be
  /// another.
  virtual PoseEstimate assumed_estimate() const { return estimate(); }
  virtual LocalizationStatus status() const { return LocalizationStatus::tracking; }
};

/// Odometry alone: the baseline of all other methods.
class DeadReckoning final : public Localizer {
 public:
  explicit DeadReckoning(const PoseEstimate& start) : estimate_(start) {}
  void predict(const BodyMotion& motion) override { estimate_ = predict_pose(estimate_, motion); }
  std::vector<Match> update(const SightingSet&) override { return {}; }
  PoseEstimate estimate() const override { return estimate_; }

 private:
  PoseEstimate estimate_;
};

}  // namespace waymark::localization
