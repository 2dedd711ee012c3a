// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <unordered_map>
#include "localization/filters/sighting_score.hpp"
#include "localization/identification/joint_search.hpp"
#include "localization/identification/landmark_window.hpp"
#include "localization/line_of_sight.hpp"
#include "localization/localizer.hpp"
namespace waymark {

struct HypothesesOptions {
  std::int64_t most = 40;  ///< Gaussians kept
  /// Weight of a Gaussian, relative to the best, to be kept. Sightings err more often by far than any
  /// Gaussian says, so one that seems 1 : 100 000 may yet be right; how many are kept bounds the cost.
  double least = 1e-6;
  double merge = 0.5;            ///< Gaussians nearer than this (squared Mahalanobis distance) become one
  double split_yaw = 0.25;       ///< rad: Gaussians wider than this are split before they meet sightings
  std::int64_t lost_after = 10;  ///< sets in a row that fit nowhere until the search begins
  /// m driven until a landmark's error on the map counts as new. Whoever sees a landmark again and again sees
  /// the same error of the map: after n sightings in a row its variance counts 1 + n/2 times, with which the
  /// filter's errors were as large as it says in made stands. 0: each errs anew.
  double same_error = 15;
  double search_growth = 2;  ///< of the standard deviations per further set; 1: it does not search
  bool unscented = false;    ///< moves and updates by sigma points instead of derivatives

  void describe(OptionVisitor& option);
};

/// An extended (or unscented) Kalman filter for landmarks that do not say who they are: a sum of Gaussians,
/// one for each way to pair what was seen with the map that is still probable (multiple hypotheses: Reid
/// 1979; for localization Jensfelt & Kristensen 2001). A doubtful pairing is not decided, it waits for more
/// sightings. Sightings are called matched when all Gaussians together are certain enough
/// (IdentificationOptions).
class HypothesesFilter final : public Localizer {
 public:
  HypothesesFilter(const PoseEstimate& start, LandmarkWindow map, FeatureScales scales,
                   IdentificationOptions identification = {}, HypothesesOptions options = {});
  void move(const BodyMotion& motion) override;
  std::vector<Match> see(const SightingSet& seen) override;
  bool fix(const GnssFix& gnss) override { return take(gnss, 2); }
  bool fix(const HeadingFix& heading) override { return take(heading, 1); }
  /// Mean and covariance of the Gaussians that agree with the best one within a metre; of all where these
  /// have less than half the weight.
  PoseEstimate estimate() const override;
  Trust trust() const override { return missed_ >= options_.lost_after ? Trust::lost : Trust::sure; }

  /// From now on landmarks in view that a Gaussian has not seen speak against it (`expect_unseen` of the
  /// options), unless the ground hides them.
  void expect_landmarks(const WeightOptions& view, LineOfSight visible);

  std::size_t hypotheses() const { return parts_.size(); }

 private:
  struct Part {
    PoseEstimate at;
    double weight = 1;        // they sum to 1
    std::vector<int> choice;  // landmark of each sighting of the set at hand, or -1
  };
  template <class Fix>
  bool take(const Fix& measured, int rows);
  void widen(double factor);
  void split();
  void prune();
  void see_some(const SightingSet& some, const LandmarkGrid& map);
  /// Sightings of a landmark of late that erred alike.
  double alike(LandmarkKey key) const;
  void miss(const SightingSet& seen, const LandmarkGrid& map);
  PoseEstimate updated_by(const Part& part, const SightingSet& some, const std::vector<Candidates>& sets,
                          const JointHypothesis& how, const LandmarkGrid& map) const;

  LandmarkWindow map_;
  FeatureScales scales_;
  IdentificationOptions identification_;
  HypothesesOptions options_;
  std::vector<Part> parts_;
  struct Use {
    double count = 0, driven = 0;  // sightings, and the way driven at the last one
  };
  std::unordered_map<LandmarkKey, Use> uses_;
  double driven_ = 0;
  std::int64_t missed_ = 0;
  FixGate gnss_, heading_;
  std::optional<WeightOptions> view_;
  LineOfSight visible_;
};

}  // namespace waymark
