// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include "localization/localizer.hpp"
namespace waymark::localization {

/// Global localization, then position tracking (Thrun, Burgard & Fox 2005, chapter 7): a localizer without a
/// start searches until its status is `tracking`. From then on another one follows the robot from the pose
/// found. A search spreads over the whole map again when the robot leaves mapped terrain; a tracking filter
/// keeps dead reckoning.
class LocatingFilter final : public Localizer {
 public:
  using Factory = std::function<std::unique_ptr<Localizer>(const PoseEstimate& found)>;
  LocatingFilter(std::unique_ptr<Localizer> search, Factory track)
      : inner_(std::move(search)), track_(std::move(track)) {}

  void predict(const BodyMotion& motion) override { inner_->predict(motion); }
  std::vector<Match> update(const SightingSet& seen) override {
    std::vector<Match> matches = inner_->update(seen);
    if (track_ && inner_->status() == LocalizationStatus::tracking) {
      inner_ = track_(inner_->estimate());
      track_ = nullptr;
    }
    return matches;
  }
  bool fix(const GnssFix& gnss) override { return inner_->fix(gnss); }
  bool fix(const HeadingFix& heading) override { return inner_->fix(heading); }
  PoseEstimate estimate() const override { return inner_->estimate(); }
  PoseEstimate assumed_estimate() const override { return inner_->assumed_estimate(); }
  LocalizationStatus status() const override { return inner_->status(); }

 private:
  std::unique_ptr<Localizer> inner_;
  Factory track_;  // empty once the robot is found
};

}  // namespace waymark::localization
