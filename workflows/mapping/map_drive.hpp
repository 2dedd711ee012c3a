// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>
#include "importers/logs/import_log.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// A drive with known poses that becomes a map.
struct DriveMapRequest {
  std::string log;    ///< file, or folder of a dataset
  std::string poses;  ///< track.csv: t, x, y, yaw, or TUM; empty: the true poses of the log
  std::string map;    ///< to write; an older map of that name is replaced
  std::string crs;    ///< of the poses, local or projected; empty: the log's, else local
  importers::LogImport log_format = {};
  /// Detectors for scans, separated by commas. 3-D scans are searched by all of theirs if none is named;
  /// laser scans are then not used if only detectors for 3-D scans are.
  std::string scans = "walls,wall_lines";
  double max_range = 20;          ///< m, > 0: farther sightings are not used
  std::string command_line = {};  ///< recorded in the map
};

/// What a drive gave.
struct DriveMapResult {
  std::string crs = {};
  std::int64_t looks = 0;                              ///< scans and sets of sightings at known poses
  std::int64_t sightings = 0;                          ///< in these looks
  std::map<std::string, std::int64_t> rejected = {};   ///< sightings and landmarks, by reason
  std::map<std::string, std::int64_t> landmarks = {};  ///< written, by type
};

/// Makes a map of what a robot saw from known poses: its sightings become landmarks with evidence, counts and
/// quality. Poses may cover parts of the drive; the rest is not used.
/// Throws Error{usage} for unknown detectors, Error{input} for a log without a look at a known pose.
/// Messages: remarks on the log, counts.
DriveMapResult map_drive(const DriveMapRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
