// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/absolute_fix.hpp"
#include "localization/body_motion.hpp"
#include "localization/filters/explained.hpp"
namespace waymark {

/// Whether a filter that was told no start has found the robot. Particles that gather at one place are no
/// proof: those of all other places may have died before they were asked often enough, and in a dense map
/// much of what is seen fits anywhere. It has found the robot when a PoseFinder is sure of the same place, or
/// when the map explains 0.35 of what is seen beyond chance; no longer when less than 0.2.
/// Until then its covariance must cover every place the robot may be.
class Convergence {
 public:
  /// `prior`: what is known before anything is seen.
  explicit Convergence(const PoseEstimate& prior) : prior_(prior) {}

  void move(const BodyMotion& motion) { prior_ = moved(prior_, motion); }
  /// A position measured from outside bounds where the robot may be.
  void fix(const GnssFix& gnss);
  /// A set of sightings: the share that fits, and that fits by chance; `one_place`: the filter has gathered.
  void count(double fit, double chance, bool one_place);
  /// A finder is sure that it is here, or elsewhere.
  void confirm(const PoseEstimate& sure, const PoseEstimate& here);

  /// The filter begins anew.
  void lose() { explained_.clear(), found_ = false; }

  bool found() const { return found_; }
  /// The filter's estimate; while nothing is found, with the covariance of the prior about it.
  PoseEstimate honest(PoseEstimate estimate) const;

 private:
  PoseEstimate prior_;
  Explained explained_;
  bool found_ = false;
};

}  // namespace waymark
