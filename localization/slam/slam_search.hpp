// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/global/pose_finder.hpp"
#include "localization/global/sighting_memory.hpp"
#include "localization/localizer.hpp"
namespace waymark {

/// Tells SLAM in a map whether it still is where it believes to be. Lost is who finds less than 0.4 of the
/// landmarks of the map that he usually finds of those he should see; ground without landmarks says
/// nothing. A PoseFinder is asked about what was seen lately: every fifth set while lost or while no landmark
/// of the map was seen for ten sets (returning to the map closes the loop), every tenth in doubt. Two answers
/// in a row that agree with each other and not with SLAM are where it is.
class SlamSearch {
 public:
  explicit SlamSearch(PoseFinder finder) : finder_(std::move(finder)) {}

  void move(const BodyMotion& motion);
  /// A set that showed `found` of the `expected` landmarks of the map, and `matched` of the map in all.
  /// Returns where SLAM must begin anew, with what odometry blurs.
  std::optional<PoseEstimate> see(const SightingSet& seen, int expected, int found, int matched,
                                  const PoseEstimate& here);
  bool lost() const { return rival_ || (sets_ >= 20 && fit_ < 0.4 * usual_); }

 private:
  PoseFinder finder_;
  SightingMemory memory_;
  std::optional<PoseEstimate> rival_;
  double fit_ = 0, usual_ = 0;  // parts of the landmarks expected that were seen, of late and for long
  int sets_ = 0, waited_ = 0, strayed_ = 0;
};

}  // namespace waymark
