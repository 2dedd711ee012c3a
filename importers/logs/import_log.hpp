// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
#include "landmarks/sensor_profile.hpp"
namespace waymark::localization {
struct RobotLog;
}

namespace waymark::importers {

/// Options for reading a log.
struct LogImport {
  std::string format = {};   ///< waymark, csv, mrclam, victoria-park, carmen, rosbag2, mcap, points, isam,
                             ///< g2o, toro; empty: recognised by what is there
  std::int64_t robot = 0;    ///< MRCLAM: which of the five; 0: the robot of the named file
  std::string columns = {};  ///< csv: target=expression, separated by commas (import_csv_log)
  std::vector<std::string> topics = {};  ///< rosbag2, mcap: read these where a bag has several of a type
  /// waymark, csv: its standard deviations are those of sightings for which the log gives none.
  std::optional<SensorCoverage> sensor = {};
  /// Types that the map holds: only these are detected in 3-D scans. Empty: all of `types`.
  std::vector<TypeId> held_types = {};
  /// Names of the detectors for 3-D scans; empty: all whose types are detected.
  std::vector<std::string> point_detectors = {};
};

/// Reads a log of any format. `types` maps the types of the sightings to ids; other types become kNoSuchType.
/// Throws Error{input} with file and line, and Error{usage} for an unknown format.
localization::RobotLog import_log(const std::filesystem::path& path, const TypeRegistry& types,
                                  const LogImport& how = {});

/// Reads Waymark's own format: JSON, one object per line (docs/reference/log_format.md). Of `how` it uses
/// `sensor`, `held_types` and `point_detectors`.
localization::RobotLog import_waymark_log(const std::filesystem::path& file, const TypeRegistry& types,
                                          const LogImport& how = {});

/// Reads a text table with a time per line, and readings in its columns (docs/reference/log_format.md).
/// `columns` assigns expressions to targets: "t=stamp/1000,v=speed,omega=rad(rate)"; columns named like a
/// target are used without. A line gives a record of each kind whose needed fields it has.
/// Throws Error{usage} for unknown targets and columns, and for kinds that lack a needed field.
localization::RobotLog import_csv_log(const std::filesystem::path& file, const std::string& columns,
                                      const TypeRegistry& types,
                                      const std::optional<SensorCoverage>& sensor = {});

/// Reads UTIAS MRCLAM (Leung et al. 2011): the folder of a dataset with `robot`, or one of its RobotK_*.dat.
/// Landmarks have type `beacon` and their subject number as uid ("6"); other robots have no type. If the map
/// has no type `beacon`, sightings are of any type.
localization::RobotLog import_mrclam_log(const std::filesystem::path& path, std::int64_t robot,
                                         const TypeRegistry& types);

/// Reads Landmark_Groundtruth.dat of an MRCLAM dataset (or its folder), in a local CRS. `type` is the type of
/// the landmarks.
std::vector<Landmark> import_mrclam_landmarks(const std::filesystem::path& path, TypeId type,
                                              const LandmarkType& declared);

/// Reads a graph file (graph_file.hpp) as a graph, and as steps and sightings with known identities, one time
/// unit per pose. Loop closures that are not steps of the drive are in the graph only.
localization::RobotLog import_graph_log(const std::filesystem::path& file, const std::string& format);

/// Reads ACFR Victoria Park as text: a folder with DRS.txt, LASER.txt, GPS.txt. Scans are of a laser on the
/// front bumper; the truth is GPS, positions only (yaw 0).
localization::RobotLog import_victoria_park(const std::filesystem::path& folder);

/// Reads a CARMEN log (Montemerlo et al. 2003): odometry as steps, and the scans of FLASER, RLASER and
/// ROBOTLASER1. Times are those of the sender. Lines that cannot be read are skipped and counted.
localization::RobotLog import_carmen_log(const std::filesystem::path& file);

/// Reads a bag of ROS 2 without ROS: a .db3 or .mcap file, or the folder of a recording. Throws Error{input}.
/// - Odometry becomes steps; scans get their pose on the robot from tf and tf_static.
/// - Satellite fixes are in degrees (`fix_crs`). An IMU gives the yaw where odometry has none, and headings.
/// - Point clouds become sightings by `held_types` and `point_detectors` of `how`. The files are read twice
///   for them, so that one cloud is in memory at a time.
/// - Of several topics of a type, the one in `topics` of `how` is read, else the one with the most messages.
/// - Messages that cannot be read, and those of other types, are skipped and counted.
localization::RobotLog import_bag_log(const std::filesystem::path& path, const TypeRegistry& types = {},
                                      const LogImport& how = {});

/// Reads a folder of 3-D scans (point_files.hpp), or its subfolder `velodyne`, in the order of their names:
/// each becomes sightings by `held_types` and `point_detectors` of `how`, so that one scan is in memory at a
/// time. `times.txt` gives their seconds. There is no odometry: poses come from elsewhere, as in `waymark map
/// --poses`.
localization::RobotLog import_point_log(const std::filesystem::path& folder, const TypeRegistry& types,
                                        const LogImport& how = {});
/// Returns whether a folder holds 3-D scans.
bool is_point_log(const std::filesystem::path& folder);

}  // namespace waymark::importers
