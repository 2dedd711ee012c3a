// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/global/pose_finder.hpp"
#include "localization/global/sighting_memory.hpp"
#include "localization/localizer.hpp"
namespace waymark::localization {

/// Detects and repairs localization failure of SLAM in a map.
/// - The PoseFinder is called on recent sightings: every twentieth set, as matches in a dense map are no
///   proof; every tenth in doubt; every fifth while lost, or after ten sets without a landmark of the map
///   (returning to the map closes the loop). Two consecutive answers that agree with each other and not with
///   SLAM are accepted.
/// - Lost: an answer contradicts SLAM, or SLAM finds less than 0.4 of the expected landmarks that it usually
///   finds and no answer confirms it. Terrain without landmarks does not count.
class SlamRelocalization {
 public:
  explicit SlamRelocalization(PoseFinder finder, FeatureScales scales = {})
      : finder_(std::move(finder)), memory_(std::move(scales)) {}

  void predict(const BodyMotion& motion);
  /// Adds a set that showed `found` of the `expected` landmarks of the map, and `matched` of the map in
  /// all. Returns the pose at which SLAM must restart.
  std::optional<PoseEstimate> update(const SightingSet& seen, int expected, int found, int matched,
                                     const PoseEstimate& here);
  bool lost() const { return rival_ || (sets_ >= 20 && fit_ < 0.4 * usual_); }

 private:
  PoseFinder finder_;
  SightingMemory memory_;
  std::optional<PoseEstimate> rival_;
  double fit_ = 0, usual_ = 0;  // fractions of the expected landmarks that were seen, short and long term
  int sets_ = 0, sets_since_query_ = 0, unmatched_sets_ = 0;
};

}  // namespace waymark::localization
