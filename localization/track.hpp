// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>
#include "localization/localizer.hpp"
namespace waymark {

/// Where a localizer believed the robot to be after one event of a log.
struct TrackRow {
  double t = 0;  ///< s
  PoseEstimate at;
  double z = 0, roll = 0, pitch = 0;  ///< 0 where the ground is not known
  int matched = 0, rejected = 0;      ///< sightings of this event
  int wrong = 0;                      ///< matched with another landmark than the log says
  bool lost = false;
  double nis = 0;      ///< normalized innovation squared of all matches: v' S^-1 v, from the estimate before
  int nis_rows = 0;    ///< its degrees of freedom; 0 without matches, of particles and SLAM
  double seconds = 0;  ///< in the update, if it was measured
};

struct Track {
  std::vector<TrackRow> rows;
  std::array<std::int64_t, kVerdicts> verdicts{};  ///< sightings by what became of them
  std::int64_t named = 0;                          ///< matched sightings of which the log knows the landmark
  std::int64_t wrong = 0;                          ///< of these, matched with another
  std::int64_t updates = 0;                        ///< sets of sightings
  std::int64_t fixes = 0, fixes_rejected = 0;      ///< GNSS and compass readings
  double seconds = 0;                              ///< in updates, if it was measured
};

}  // namespace waymark
