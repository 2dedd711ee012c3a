// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include "localization/filters/explained_fraction.hpp"
#include "localization/filters/regain_evidence.hpp"
#include "localization/global/pose_claims.hpp"
#include "localization/global/pose_finder.hpp"
#include "localization/global/sighting_memory.hpp"
#include "localization/localizer.hpp"
namespace waymark::localization {

/// A filter with recovery from localization failure: a kidnapped robot, a wrong association, or the return
/// from unmapped terrain.
///
/// The filter counts as lost in three cases:
/// - It reports so.
/// - Less than half of the usual fraction of its recent sightings have a landmark. In a dense map some
///   landmark fits by chance at any pose.
/// - The map explains less of the sightings beyond chance (ExplainedFraction) than a fifth, or two fifths of
///   the usual fraction if that is less. The estimate is then the last reliable one, or the start, predicted
///   by odometry and updated by fixes.
///
/// A lost filter calls the PoseFinder on recent sightings, at most every fifth set, since that searches the
/// whole map; without a start more often at first (search_interval). If the finder is certain, the filter
/// restarts at its pose. Otherwise it restarts every twentieth set at the last reliable estimate, predicted
/// by odometry, because its matches since then are not reliable. A pose out of odometry's reach needs three
/// answers that agree (PoseClaims).
///
/// With a NearPoseFinder a filter that was lost stays so until its pose is proven: by the objects matched
/// since (RegainEvidence), or by a search of the poses that odometry allows, every third set. While chance
/// explains its matches, the estimate is the last reliable one, predicted by odometry, and the filter
/// restarts there every twentieth set; while it does not, there are no restarts.
class RelocalizingFilter final : public Localizer {
 public:
  using Factory = std::function<std::unique_ptr<Localizer>(const PoseEstimate&)>;
  /// `start_known`: false if `start` only says where the robot may be (pose_anywhere). The filter is then
  /// lost and uses no sighting before the finder is certain.
  RelocalizingFilter(const PoseEstimate& start, Factory factory, PoseFinder finder,
                     ChanceFraction chance = {}, FeatureScales scales = {}, bool start_known = true,
                     NearPoseFinder near = {});

  void predict(const BodyMotion& motion) override;
  std::vector<Match> update(const SightingSet& seen) override;
  bool fix(const GnssFix& gnss) override { return apply_fix(gnss); }
  bool fix(const HeadingFix& heading) override { return apply_fix(heading); }
  PoseEstimate estimate() const override { return is_reckoned() ? reliable_ : inner_->estimate(); }
  PoseEstimate assumed_estimate() const override {
    return is_reckoned() ? reliable_ : inner_->assumed_estimate();
  }
  LocalizationStatus status() const override { return lost() ? LocalizationStatus::lost : inner_->status(); }
  int restarts() const { return restarts_; }

 private:
  template <class Fix>
  bool apply_fix(const Fix& fix) {
    if (!located_) {
      const auto fixed = update_pose(reliable_, fix);
      const bool fits = fixed.squares < 16 && is_informative(fix);
      if (fits) reliable_ = fixed.estimate;
      return fits;
    }
    const bool used = inner_->fix(fix);
    // A tracking filter replaces dead reckoning. Errors of fixes are correlated: many are no better than one.
    if (used && !lost() && is_explained())
      trust(inner_->estimate());
    else if (const auto fixed = update_pose(reliable_, fix); fixed.squares < 16 && is_informative(fix))
      reliable_ = fixed.estimate;
    return used;
  }
  bool lost() const;
  void trust(const PoseEstimate& at) { reliable_ = at, claims_.trust(); }
  void restart(const PoseEstimate& at);
  bool is_informative(const GnssFix& f) const {
    return reliable_.covariance(0, 0) + reliable_.covariance(1, 1) > 2 * f.sd * f.sd;
  }
  bool is_informative(const HeadingFix& f) const { return reliable_.covariance(2, 2) > f.sd * f.sd; }
  bool is_explained() const;
  bool is_reckoned() const { return chance_matches_ || !located_ || by_chance_; }
  bool fails() const;
  void judge_matches();
  bool search_near(const SightingSet& seen);
  bool relocate(const SightingSet& seen);

  Factory make_filter_;
  PoseFinder finder_;
  NearPoseFinder near_;
  ChanceFraction chance_;
  ExplainedFraction explained_;
  std::unique_ptr<Localizer> inner_;
  FeatureScales scales_;
  SightingMemory memory_;
  PoseEstimate reliable_;  // the last reliable estimate, predicted by odometry since
  PoseClaims claims_;
  double fit_ = 1;               // fraction of the sightings with a landmark, over about the last ten sets
  double usual_fit_ = 2.0 / 3;   // the same over about the last hundred sets while not lost
  int usual_sets_ = 5;           // sets that count in it; five for the value it begins with
  bool located_ = true;          // false until a filter without a start is found
  bool chance_matches_ = false;  // whether the matches were found to fit by chance
  bool regained_ = true;         // false from a loss until the sightings prove the pose
  bool by_chance_ = false;       // whether other poses that odometry allows fit as well
  RegainEvidence evidence_;
  int sets_since_search_ = 0, near_searches_ = 0;
  int sets_since_query_ = 0, unresolved_sets_ = 0, restarts_ = 0;
  int sets_without_pose_ = 0;  // of a filter without a start, until it is found
};

}  // namespace waymark::localization
