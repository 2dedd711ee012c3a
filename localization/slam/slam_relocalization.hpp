// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/global/pose_finder.hpp"
#include "localization/global/sighting_memory.hpp"
#include "localization/localizer.hpp"
namespace waymark::localization {

/// Comparison of two poses by the sightings that come after the second was proposed. Sightings that both or
/// neither explain decide nothing; of the others, each pose has half under the hypothesis that they are
/// equally good (sign test; McNemar 1947).
struct PoseTrial {
  int for_rival = 0, for_own = 0;  ///< sightings that only one of the two explains by a landmark of the map
  int sets = 0;

  void add(bool own, bool rival) { for_rival += rival && !own, for_own += own && !rival; }
  /// Returns the probability of at least `for_rival` of the deciding sightings if both poses are equally
  /// good.
  double chance_of_rival() const;
  double chance_of_own() const;
};

/// Detects and repairs localization failure of SLAM in a map.
/// - Every twentieth set the pose is checked with recent sightings: matches in a dense map are no proof.
/// - The finder searches the whole map if the check fails; in doubt (every tenth set); while lost (every
///   fifth); and after ten sets without a landmark of the map (returning to the map closes the loop).
/// - A pose found that contradicts SLAM is put on trial. The sightings that made it are no evidence in the
///   trial: they share its errors.
/// - Lost: the trial favours the other pose, or SLAM finds less than 0.4 of the expected landmarks that it
///   usually finds and no answer confirms it. Terrain without landmarks does not count.
class SlamRelocalization {
 public:
  explicit SlamRelocalization(PoseFinder finder, PoseCheck check = {}, FeatureScales scales = {})
      : finder_(std::move(finder)), check_(std::move(check)), memory_(std::move(scales)) {}

  void predict(const BodyMotion& motion) { memory_.predict(motion); }
  /// Adds a set that showed `found` of the `expected` landmarks of the map, and `matched` of the map in
  /// all. Returns a pose to put on trial.
  std::optional<PoseEstimate> update(const SightingSet& seen, int expected, int found, int matched,
                                     const PoseEstimate& here);

  enum class Verdict { open, own, rival };
  /// Starts a trial.
  void begin_trial() { trial_.emplace(); }
  PoseTrial* trial() { return trial_ ? &*trial_ : nullptr; }
  /// Ends the trial if it is decided.
  Verdict decide();
  bool lost() const;

 private:
  bool is_confirmed(const SightingSet& seen, const PoseEstimate& here);

  PoseFinder finder_;
  PoseCheck check_;
  SightingMemory memory_;
  std::optional<PoseTrial> trial_;
  double fit_ = 0, usual_ = 0;  // fractions of the expected landmarks that were seen, short and long term
  int sets_ = 0, sets_since_query_ = 0, unmatched_sets_ = 0;
};

}  // namespace waymark::localization
