// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "localization/localizer.hpp"
namespace waymark::localization {

/// Estimate of a localizer after one event of a log.
struct TrackRow {
  double t = 0;  ///< s
  PoseEstimate at;
  double z = 0, roll = 0, pitch = 0;  ///< 0 where the terrain is unknown
  int matched = 0, rejected = 0;      ///< sightings of this event
  int wrong = 0;                      ///< matches that contradict the landmark given in the log
  bool lost = false;
  double nis = 0;      ///< normalized innovation squared of all matches: v' S^-1 v, from the prediction
  int nis_rows = 0;    ///< its degrees of freedom; 0 without matches, and for particles and SLAM
  double seconds = 0;  ///< of the update, if timed
};

/// Least-squares fit of a whole drive.
struct GraphFit {
  double chi2 = 0;  ///< sum of squared whitened errors, without kernel
  std::int64_t residuals = 0, unknowns = 0;
  bool converged = false;
};

/// Search for the pose in the whole map: the last one that found the robot, or the last of all.
struct PoseSearchRecord {
  std::optional<double> t;                       ///< s, of a pose that was accepted; absent: none was
  PoseEstimate at;                               ///< that pose
  std::string reason = {};                       ///< why none was
  std::optional<double> wrong_probability = {};  ///< that the best pose is not the robot's, if it is known
};

/// Estimates along a log, with counts over all events.
struct Track {
  std::vector<TrackRow> rows;
  std::array<std::int64_t, kVerdicts> verdicts{};  ///< sightings by verdict
  std::int64_t named = 0;                          ///< matched sightings with a landmark given in the log
  std::int64_t wrong = 0;                          ///< matches among these with another landmark
  std::int64_t updates = 0;                        ///< sets of sightings
  std::int64_t fixes = 0, fixes_rejected = 0;      ///< GNSS and compass readings
  double seconds = 0;                              ///< of all updates, if timed
  std::optional<PoseSearchRecord> search = {};     ///< of methods that searched the whole map
  std::optional<GraphFit> graph = {};              ///< of methods that optimise a graph
  /// Sensors' place on the robot, forward, left and yaw beside that of the log, if it is estimated.
  std::optional<PoseEstimate> mount = {};
};

}  // namespace waymark::localization
