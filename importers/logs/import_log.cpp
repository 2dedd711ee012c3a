// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/import_log.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "importers/logs/bag_file.hpp"
#include "importers/logs/graph_file.hpp"
#include "localization/robot_log.hpp"

namespace waymark::importers {
namespace {

namespace fs = std::filesystem;

std::string recognised(const fs::path& path) {
  if (fs::is_directory(path)) {
    if (fs::exists(path / "Barcodes.dat")) return "mrclam";
    if (fs::exists(path / "LASER.txt") && fs::exists(path / "DRS.txt")) return "victoria-park";
    if (!bag_files(path).empty()) return "rosbag2";
    if (is_point_log(path)) return "points";
    throw Error(ErrorCode::input, "the folder holds no log of a known format", path.string(),
                "known are MRCLAM (Barcodes.dat), Victoria Park (LASER.txt, DRS.txt), bags of ROS 2 (.db3, "
                ".mcap, also with .zstd behind) and 3-D scans (.bin, .ply)");
  }
  if (!fs::exists(path))
    throw Error(ErrorCode::input, "there is no such log", path.string(), "check the path");
  if (path.extension() == ".csv" || path.extension() == ".tsv") return "csv";
  if (begins_like_ros1(path))
    throw Error(ErrorCode::input, "the file is a bag of ROS 1", path.string(),
                "bags of ROS 2 are read: `rosbags-convert` (python3 -m pip install rosbags) converts it");
  if (begins_like_mcap(path)) return "mcap";
  if (is_bag(path)) return path.extension() == ".mcap" ? "mcap" : "rosbag2";
  if (path.extension() == ".dat") return "mrclam";
  const std::string name = path.filename().string();
  if (path.extension() == ".clf" || name.ends_with(".clf.gz") || name.ends_with(".clf.bz2")) return "carmen";
  if (name == "LASER.txt" || name == "DRS.txt") return "victoria-park";
  const std::string graph = graph_format(path);
  return graph.empty() ? "waymark" : graph;
}

/// Longest time between two records, seconds: twelve days. Nothing is known of a robot's pose after it, and a
/// single wild stamp would make every uncertainty of the log boundless.
constexpr double kMaxPause = 1e6;

void check_times(const localization::RobotLog& log, const fs::path& path) {
  const auto check = [&](const auto& records, const char* what) {
    for (std::size_t i = 1; i < records.size(); ++i)
      if (const double pause = records[i].t - records[i - 1].t; !(pause <= kMaxPause))
        throw Error(ErrorCode::input,
                    fmt::format("a time stamp is wrong: after {:.15g} s, the next {} is at {:.15g} s",
                                records[i - 1].t, what, records[i].t),
                    path.string(), "correct or remove that record; stamps are seconds of one clock");
  };
  check(log.events, "reading");
  check(log.truth, "true pose");
  check(log.felled, "felled tree");
}

localization::RobotLog read_log(const fs::path& path, const TypeRegistry& types, const LogImport& how) {
  const std::string format = !how.format.empty()    ? how.format
                             : !how.columns.empty() ? "csv"
                                                    : recognised(path);
  if (!how.columns.empty() && format != "csv")
    throw Error(ErrorCode::usage, "columns are given for a log of the format " + format, path.string(),
                "only text tables (csv) have columns");
  if (!how.topics.empty() && format != "rosbag2" && format != "mcap")
    throw Error(ErrorCode::usage, "topics are given for a log of the format " + format, path.string(),
                "only bags of ROS 2 (rosbag2, mcap) have topics");
  if (how.robot != 0 && format != "mrclam")
    throw Error(ErrorCode::usage,
                fmt::format("robot {} is asked for in a log of the format {}", how.robot, format),
                path.string(), "only datasets of MRCLAM have several robots");
  if (format == "csv") return import_csv_log(path, how.columns, types, how.sensor);
  if (format == "waymark") return import_waymark_log(path, types, how);
  if (format == "mrclam") return import_mrclam_log(path, how.robot, types);
  if (format == "victoria-park")
    return import_victoria_park(fs::is_directory(path) ? path : path.parent_path());
  if (format == "carmen") return import_carmen_log(path);
  if (format == "rosbag2" || format == "mcap") return import_bag_log(path, types, how);
  if (format == "points") return import_point_log(path, types, how);
  if (format == "isam" || format == "g2o" || format == "toro") return import_graph_log(path, format);
  throw Error(
      ErrorCode::usage, "there is no log format '" + format + "'", path.string(),
      "known are waymark, csv, mrclam, victoria-park, carmen, rosbag2, mcap, points, isam, g2o and toro");
}

}  // namespace

localization::RobotLog import_log(const fs::path& path, const TypeRegistry& types, const LogImport& how) {
  localization::RobotLog log = read_log(path, types, how);
  check_times(log, path);
  return log;
}

}  // namespace waymark::importers
