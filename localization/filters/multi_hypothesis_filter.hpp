// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include "localization/filters/kalman.hpp"
#include "localization/filters/map_errors.hpp"
#include "localization/filters/sighting_score.hpp"
#include "localization/identification/joint_search.hpp"
#include "localization/identification/landmark_matcher.hpp"
#include "localization/identification/sighting_follower.hpp"
#include "localization/line_of_sight.hpp"
#include "localization/localizer.hpp"
namespace waymark::localization {

/// Options of the multi-hypothesis filter.
struct MultiHypothesisOptions {
  std::int64_t max_hypotheses = 40;  ///< largest number of Gaussians
  /// Smallest weight of a Gaussian relative to the best. Sightings err more often than any Gaussian says,
  /// so a hypothesis at 1 : 100 000 may yet be right. The cost is bounded by the number of Gaussians.
  double min_weight = 1e-6;
  double merge = 0.5;       ///< Gaussians nearer than this (squared Mahalanobis distance) are merged
  double split_yaw = 0.25;  ///< rad: Gaussians wider than this are split before an update
  double error_correlation_distance = 200;  ///< m: memory of MapErrors
  KalmanOptions search;                     ///< of a lost filter; described by its owner
  bool unscented = false;                   ///< predicts and updates by sigma points instead of derivatives

  void describe(OptionVisitor& option);
};

/// Extended (or unscented) Kalman filter for landmarks without identities: a Gaussian mixture with one
/// component per data association that is still probable. It is a multiple hypothesis tracker (Reid 1979;
/// for localization Jensfelt & Kristensen 2001). An ambiguous association stays open until further
/// sightings decide it. A sighting is matched when the whole mixture is certain enough
/// (IdentificationOptions).
class MultiHypothesisFilter final : public Localizer {
 public:
  MultiHypothesisFilter(const PoseEstimate& start, LandmarkMatcher matcher,
                        MultiHypothesisOptions options = {});
  void predict(const BodyMotion& motion) override;
  std::vector<Match> update(const SightingSet& seen) override;
  bool fix(const GnssFix& gnss) override { return apply_fix(gnss, 2); }
  bool fix(const HeadingFix& heading) override { return apply_fix(heading, 1); }
  /// Returns mean and covariance of the Gaussians within a metre of the best one. If these have less than
  /// half the weight, those of all Gaussians.
  PoseEstimate estimate() const override;
  LocalizationStatus status() const override {
    return missed_ >= options_.search.lost_after ? LocalizationStatus::lost : LocalizationStatus::tracking;
  }

  /// Makes unseen landmarks in view count against a Gaussian (`expect_unseen` of the options), unless the
  /// terrain hides them.
  void expect_landmarks(const WeightOptions& view, LineOfSight visible);

  std::size_t hypotheses() const { return components_.size(); }

 private:
  struct Component {
    PoseEstimate at;
    MapErrors errors;
    double weight = 1;        // they sum to 1
    std::vector<int> choice;  // landmark of each sighting of the current set, or -1
    std::map<int, std::optional<LandmarkKey>> of_object;  // decisions on objects that are followed
  };
  template <class Fix>
  bool apply_fix(const Fix& measured, int rows);
  void widen(double factor);
  void split();
  void prune();
  void update_jointly(const SightingSet& some, std::span<const SightingFollower::Seen> objects,
                      const LandmarkGrid& map);
  void weigh_unseen(const SightingSet& seen, const LandmarkGrid& map);
  void update_component(Component& component, const SightingSet& some, const std::vector<Candidates>& sets,
                        const JointHypothesis& how, const LandmarkGrid& map) const;

  LandmarkMatcher matcher_;
  MultiHypothesisOptions options_;
  std::vector<Component> components_;
  SightingFollower follower_;
  std::int64_t missed_ = 0;
  FixGate gnss_, heading_;
  std::optional<WeightOptions> view_;
  LineOfSight visible_;
};

}  // namespace waymark::localization
