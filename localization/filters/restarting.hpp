// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include "localization/filters/explained.hpp"
#include "localization/global/pose_finder.hpp"
#include "localization/global/sighting_memory.hpp"
#include "localization/localizer.hpp"
namespace waymark {

/// A filter that follows one place and finds back when it has lost it: kidnapped, misled, or returned from
/// ground that is not on the map.
///
/// Lost is a filter that says so, and one that has a landmark for less than a third of what it saw lately, or
/// for less than half of what it usually has: in a dense map some landmark fits by chance wherever the robot
/// believes to be. A PoseFinder is then asked about what was seen lately, at most every fifth set, since it
/// looks at the whole map; where it is sure the filter begins anew there. Where it is not, what the lost
/// filter has paired meanwhile is not believed either: every twentieth set it begins anew from where it was
/// when all was well, carried along by odometry with the covariance that this has.
///
/// Lost too is a filter whose map explains less than a fifth of what it sees beyond chance (Explained). Its
/// estimate is then the one of when all was well, or the start, moved by odometry and by fixes from outside.
class Restarting final : public Localizer {
 public:
  using Begin = std::function<std::unique_ptr<Localizer>(const PoseEstimate&)>;
  Restarting(const PoseEstimate& start, Begin begin, PoseFinder finder, ChanceShare chance = {});

  void move(const BodyMotion& motion) override;
  std::vector<Match> see(const SightingSet& seen) override;
  bool fix(const GnssFix& gnss) override { return take(gnss); }
  bool fix(const HeadingFix& heading) override { return take(heading); }
  PoseEstimate estimate() const override { return by_chance_ ? carried_ : inner_->estimate(); }
  Trust trust() const override { return lost() ? Trust::lost : inner_->trust(); }
  int restarts() const { return restarts_; }

 private:
  template <class Fix>
  bool take(const Fix& fix) {
    const bool used = inner_->fix(fix);
    // Who knows where it is needs no dead reckoning; errors of fixes last, so that many are no better.
    if (used && !lost() && proven())
      carried_ = inner_->estimate();
    else if (const auto fixed = updated(carried_, fix); fixed.squares < 16 && is_news(fix))
      carried_ = fixed.estimate;
    return used;
  }
  bool lost() const;
  void begin_anew(const PoseEstimate& at);
  std::vector<Match> follow(PoseEstimate found, const SightingSet& seen);
  bool is_news(const GnssFix& f) const {
    return carried_.covariance(0, 0) + carried_.covariance(1, 1) > 2 * f.sd * f.sd;
  }
  bool is_news(const HeadingFix& f) const { return carried_.covariance(2, 2) > f.sd * f.sd; }
  bool proven() const { return !chance_ || (explained_.known() && explained_.share() > 0.3); }

  Begin begin_;
  PoseFinder finder_;
  ChanceShare chance_;
  Explained explained_;
  std::unique_ptr<Localizer> inner_;
  SightingMemory memory_;
  PoseEstimate carried_;    // the last estimate while all was well, moved by odometry since
  double fit_ = 1;          // part of the sightings that have a landmark, of about the last ten sets
  double usual_ = 2.0 / 3;  // the same of about the last hundred sets while not lost
  bool by_chance_ = false;  // what fits was found to fit by chance, and nothing has been proven since
  int waited_ = 0, in_vain_ = 0, restarts_ = 0;
};

}  // namespace waymark
