// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/filters/explained_fraction.hpp"
#include "localization/global/pose_claims.hpp"
#include "localization/global/pose_finder.hpp"
#include "localization/global/sighting_memory.hpp"
#include "localization/localizer.hpp"
#include "localization/slam/found_fraction.hpp"
namespace waymark::localization {

/// Comparison of two poses by the sightings that come after the second was proposed. Sightings that both or
/// neither explain decide nothing; of the others, each pose has half under the hypothesis that they are
/// equally good (sign test; McNemar 1947).
struct PoseTrial {
  int for_rival = 0, for_own = 0;  ///< sightings that only one of the two explains by a landmark of the map
  int sets = 0;
  bool by_finder = true;  ///< proposed by the finder; a search may replace it otherwise

  void add(bool own, bool rival) { for_rival += rival && !own, for_own += own && !rival; }
  /// Returns the probability of at least `for_rival` of the deciding sightings if both poses are equally
  /// good.
  double chance_of_rival() const;
  double chance_of_own() const;
};

/// What one set of sightings says about the pose of SLAM in a map.
struct SetEvidence {
  std::vector<ExpectedLook> expected;  ///< landmarks of the map that should be seen
  int matched = 0;                     ///< sightings of a landmark of the map, expected or not
  double fit = -1, chance = -1;  ///< fractions that the map explains, here and at a wrong pose; < 0: none
};

/// Detects and repairs localization failure of SLAM in a map.
/// - Every twentieth set the pose is checked with recent sightings: matches in a dense map are no proof.
/// - The finder searches the whole map if the check fails; in doubt (every tenth set); while lost (every
///   fifth); and after ten sets without a landmark of the map (returning to the map closes the loop).
/// - A pose found that contradicts SLAM is put on trial. The sightings that made it are no evidence in the
///   trial: they share its errors.
/// - In unmapped terrain landmarks that match by chance win a trial. A pose out of odometry's reach is put on
///   trial there after three answers that agree (PoseClaims). EkfSlam refuses one that its past contradicts
///   (PastSets).
/// - Lost: the trial favours the other pose, or a trial of the finder's pose began in doubt.
/// - Lost also: two fractions are small and no answer confirms the pose. SLAM finds less than 0.4 of the
///   expected landmarks that it usually finds (FoundFraction); terrain without landmarks does not count. And
///   the map explains less than half of the usual fraction of its sightings, or less than a fifth beyond
///   chance. Terrain that hides landmarks makes only the first one small, unmapped objects only the second.
class SlamRelocalization {
 public:
  explicit SlamRelocalization(PoseFinder finder, PoseCheck check = {}, FeatureScales scales = {})
      : finder_(std::move(finder)), check_(std::move(check)), scales_(std::move(scales)), memory_(scales_) {}

  void predict(const BodyMotion& motion) { memory_.predict(motion), claims_.predict(motion); }
  /// Adds a set. Returns a pose to put on trial.
  std::optional<PoseEstimate> update(const SightingSet& seen, const SetEvidence& evidence,
                                     const PoseEstimate& here);

  enum class Verdict { open, own, rival };
  /// Starts a trial of a pose of the finder, or of another source.
  void begin_trial(bool by_finder) { trial_.emplace().by_finder = by_finder; }
  /// Ends the trial without a verdict: the poses agree.
  void end_trial() { trial_.reset(); }
  PoseTrial* trial() { return trial_ ? &*trial_ : nullptr; }
  /// Ends the trial if it is decided.
  Verdict decide();
  bool lost() const;

 private:
  void learn(const SetEvidence& evidence);
  double fit() const { return found_.value(usual_); }
  bool is_explained() const;
  bool is_confirmed(const SightingSet& seen, const PoseEstimate& here);

  PoseFinder finder_;
  PoseCheck check_;
  FeatureScales scales_;
  SightingMemory memory_;
  PoseClaims claims_;
  std::optional<PoseTrial> trial_;
  FoundFraction found_;                             // of the expected landmarks
  double usual_ = 0;                                // the same over some hundred sets
  double explained_fit_ = 0, usual_explained_ = 0;  // fractions of the sightings that the map explains
  ExplainedFraction beyond_chance_;
  int explained_sets_ = 0;
  int sets_ = 0, sets_since_query_ = 0, sets_since_check_ = 0, unmatched_sets_ = 0;
};

}  // namespace waymark::localization
