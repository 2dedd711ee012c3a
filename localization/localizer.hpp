// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "localization/absolute_fix.hpp"
#include "localization/body_motion.hpp"
#include "localization/identification/identification.hpp"
namespace waymark {

/// What a localizer knows beside its estimate.
enum class Trust {
  sure,   ///< sightings agree with the map, or there were none
  lost,   ///< all sightings of the last sets were rejected; it is searching
  unset,  ///< no start was given and nothing seen yet
};

/// A method that follows a robot. Steps are given in the order of time.
class Localizer {
 public:
  virtual ~Localizer() = default;
  virtual void move(const BodyMotion& motion) = 0;
  /// Uses what one sensor saw at this moment; says what became of each sighting.
  virtual std::vector<Match> see(const SightingSet& seen) = 0;
  /// Uses a position or heading measured from outside; false: not used, since the method cannot or since it
  /// contradicts all the robot knows.
  virtual bool fix(const GnssFix&) { return false; }
  virtual bool fix(const HeadingFix&) { return false; }
  /// Always finite.
  virtual PoseEstimate estimate() const = 0;
  virtual Trust trust() const { return Trust::sure; }
};

/// Odometry alone: what all others are compared with.
class DeadReckoning final : public Localizer {
 public:
  explicit DeadReckoning(const PoseEstimate& start) : estimate_(start) {}
  void move(const BodyMotion& motion) override { estimate_ = moved(estimate_, motion); }
  std::vector<Match> see(const SightingSet&) override { return {}; }
  PoseEstimate estimate() const override { return estimate_; }

 private:
  PoseEstimate estimate_;
};

}  // namespace waymark
