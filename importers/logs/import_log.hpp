// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
#include "localization/robot_log.hpp"
namespace waymark {

/// How a log is read.
struct LogImport {
  std::string format =
      {};  ///< waymark, mrclam, victoria-park, isam, g2o, toro; empty: recognised by what is there
  std::int64_t robot = 0;  ///< MRCLAM: which of the five; 0: the one whose file is named
};

/// Reads a log of any format. `types` gives the sightings their type ids; sightings of a type it does not
/// have get kNoSuchType. Throws Error{input} naming file and line, and Error{usage} for an unknown format.
RobotLog import_log(const std::filesystem::path& path, const TypeRegistry& types, const LogImport& how = {});

/// Ours: JSON, one object per line (docs/log_format.md).
RobotLog import_waymark_log(const std::filesystem::path& file, const TypeRegistry& types);

/// UTIAS MRCLAM (Leung et al. 2011): a dataset's folder with `robot`, or one of its RobotK_*.dat. Landmarks
/// are of type `beacon` and known by their subject number, uid "6"; other robots have no type. Where
/// the map has no type `beacon`, sightings are of any type.
RobotLog import_mrclam_log(const std::filesystem::path& path, std::int64_t robot, const TypeRegistry& types);

/// Landmark_Groundtruth.dat of an MRCLAM dataset (or its folder), in a local CRS. `type`: of these landmarks.
std::vector<Landmark> import_mrclam_landmarks(const std::filesystem::path& path, TypeId type,
                                              const LandmarkType& declared);

/// A graph file (graph_file.hpp): the graph, and the same as steps and sightings of landmarks that say who
/// they are, one time unit per pose. Loops that are not steps of the drive are in the graph only.
RobotLog import_graph_log(const std::filesystem::path& file, const std::string& format);

/// ACFR Victoria Park as text: folder with DRS.txt, LASER.txt, GPS.txt. Scans of a laser on the front bumper;
/// the truth is GPS, positions only (yaw 0).
RobotLog import_victoria_park(const std::filesystem::path& folder);

}  // namespace waymark
