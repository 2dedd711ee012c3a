// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include "localization/localizer.hpp"
#include "localization/pose_finder.hpp"
#include "localization/sighting_memory.hpp"
namespace waymark {

/// A filter that follows one place and, where it is lost, begins anew at the place a PoseFinder is sure of.
/// Lost is a filter that says so, and one that has a landmark for less than a third of what it saw lately: in
/// a dense map some landmark fits by chance wherever the robot believes to be. What it saw lately is asked
/// about at most every fifth set, since the finder looks at the whole map.
class Restarting final : public Localizer {
 public:
  using Begin = std::function<std::unique_ptr<Localizer>(const PoseEstimate&)>;
  Restarting(const PoseEstimate& start, Begin begin, PoseFinder finder);

  void move(const BodyMotion& motion) override;
  std::vector<Match> see(const SightingSet& seen) override;
  bool fix(const GnssFix& gnss) override { return inner_->fix(gnss); }
  bool fix(const HeadingFix& heading) override { return inner_->fix(heading); }
  PoseEstimate estimate() const override { return inner_->estimate(); }
  Trust trust() const override { return fit_ < kLeastFit ? Trust::lost : inner_->trust(); }
  int restarts() const { return restarts_; }

 private:
  static constexpr double kLeastFit = 1.0 / 3;

  Begin begin_;
  PoseFinder finder_;
  std::unique_ptr<Localizer> inner_;
  SightingMemory memory_;
  double fit_ = 1;  // part of the sightings that have a landmark, of about the last ten sets
  int waited_ = 0, restarts_ = 0;
};

}  // namespace waymark
