// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/map_drive.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "exporters/vector/track_file.hpp"
#include "geo/local_frame.hpp"
#include "geodb/write_map.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/robot_log.hpp"
#include "workflows/localization/exchanged_sides.hpp"
#include "workflows/localization/log_without_landmarks.hpp"
#include "workflows/mapping/drive_landmarks.hpp"
#include "workflows/output_path.hpp"
#include "workflows/provenance.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

/// Puts the poses of a file in the place of those of the log.
void read_poses(DriveMapRequest& request, localization::RobotLog& log) {
  if (!request.poses.empty()) {
    log.truth.clear();
    const exporters::TrackFile read = exporters::read_track_file(request.poses);
    if (request.crs.empty()) request.crs = read.crs;
    if (!read.crs.empty() &&
        (request.crs == "local" || !Crs::from_text(request.crs).same_as(Crs::from_text(read.crs))))
      throw Error(ErrorCode::usage, fmt::format("the poses are in {}, not in {}", read.crs, request.crs),
                  request.poses, "leave --crs out, and convert the map: waymark export MAP OUT --crs ...");
    for (const localization::TrackRow& row : read.track.rows) log.truth.push_back({row.t, row.at.pose});
  }
  if (log.truth.empty())
    throw Error(ErrorCode::usage, "the poses of the drive are unknown", request.log,
                "give --poses TRACK.csv: t, x, y, yaw");
}

/// Returns the CRS of the poses: the CRS of the log if they are its poses, else that of the request.
Crs crs_of_poses(const DriveMapRequest& request, const localization::RobotLog& log) {
  const bool is_stated = request.poses.empty() && log.in_crs && !log.crs.empty();
  const std::string text = !request.crs.empty() ? request.crs : is_stated ? log.crs : "local";
  const Crs crs = text == "local" ? Crs::local() : Crs::from_text(text);
  if (is_stated && !crs.same_as(Crs::from_text(log.crs)))
    throw Error(ErrorCode::usage, fmt::format("the poses of the log are in {}, not in {}", log.crs, text),
                request.log, "leave --crs out, and convert the map: waymark export MAP OUT --crs ...");
  if (crs.kind() == CrsKind::geographic)
    throw Error(ErrorCode::usage, "the poses of a drive are in metres, not in degrees", "CRS " + text,
                "give poses in a projected CRS, or local ones");
  return crs;
}

/// Returns a frame about the first pose.
LocalFrame frame_of_poses(const Crs& crs, const localization::RobotLog& log) {
  const localization::Pose2& first = log.truth.front().pose;
  return {crs, crs.kind() == CrsKind::local ? Point<MapCrs>() : Point<MapCrs>{{first.x, first.y, 0}}};
}

/// Returns the landmark types that the detectors make.
std::vector<std::string> types_of(const localization::NamedDetectors& named) {
  std::set<std::string> types;
  for (const auto& names : {named.laser, named.points})
    for (const std::string& name : names)
      if (const auto* const detector = localization::scan_detectors().find(name))
        types.insert(detector->types.begin(), detector->types.end());
  return {types.begin(), types.end()};
}

}  // namespace

DriveMapResult map_drive(const DriveMapRequest& given, const Callbacks& callbacks) {
  DriveMapRequest request = given;
  if (!(request.max_range > 0 && std::isfinite(request.max_range)))
    throw Error(ErrorCode::usage, "the range must be above 0 m", "--max-range", "e.g. --max-range 40");
  check_map_output(request.map);
  keep_inputs(request.map, {request.log, request.poses});
  const auto started = std::chrono::system_clock::now();
  const TypeRegistry& types = all_types();
  const localization::NamedDetectors named = localization::name_scan_detectors(request.scans, "--scans");
  request.log_format.point_detectors = named.points;
  localization::ScanDetector detect;  // none: laser scans are not used
  if (!named.laser.empty())
    detect = localization::make_laser_detector(
        types, {.find = fmt::format("{}", fmt::join(named.laser, ",")), .features = true});
  localization::RobotLog log = importers::import_log(request.log, types, request.log_format);
  for (const std::string& remark : log.remarks) callbacks.warning(remark + ": " + request.log);
  read_poses(request, log);
  geodb::MapContents contents;
  contents.types = types;
  contents.crs = crs_of_poses(request, log);
  const LocalFrame frame = frame_of_poses(contents.crs, log);
  log.in_crs = true;
  localization::convert_to_map_frame(log, frame);
  std::filesystem::path name(request.log);
  if (!name.has_filename()) name = name.parent_path();
  const std::vector<DriveLook> looks = looks_of_drive(log, log.truth, detect, name.filename().string());
  if (looks.empty())
    throw Error(ErrorCode::input, "no scan or sighting of the log has a known pose", request.log,
                "are the poses of the same drive, with the same clock?");
  const DriveMappingOptions options{.max_range = request.max_range};
  DriveLandmarks made = landmarks_of_looks(looks, types, frame, options);
  std::size_t sightings = 0;
  for (const DriveLook& look : looks) sightings += look.seen.sightings.size();
  contents.landmarks = std::move(made.landmarks);
  contents.observations = std::move(made.evidence);
  pipeline::StageReport stage;
  stage.stage = "map_drive";
  stage.units = stage.made = static_cast<std::int64_t>(looks.size());
  stage.counts.in = static_cast<std::int64_t>(sightings);
  stage.counts.out = static_cast<std::int64_t>(contents.landmarks.size());
  if (made.improbable) stage.counts.rejected["landmark improbable"] = made.improbable;
  if (made.too_far) stage.counts.rejected["beyond max_range"] = made.too_far;
  if (made.unplaced) {
    stage.counts.rejected["no position"] = made.unplaced;
    callbacks.warning(fmt::format(
        "{} sightings have a bearing or a range alone, which gives no position: they are left out: {}",
        made.unplaced, request.log));
  }
  if (made.untyped) {
    stage.counts.rejected["no type"] = made.untyped;
    callbacks.warning(fmt::format(
        "{} sightings have no type, or one that several detectors leave open: they are left out; name one "
        "detector of single objects, such as --scans poles: {}",
        made.untyped, request.log));
  }
  if (const std::string fault = unusable_ranges_warning(log); detect && !fault.empty())
    callbacks.warning(fault + ": " + request.log);
  if (const std::string fault = exchanged_sides_warning(log, log.truth, "the poses"); !fault.empty())
    callbacks.warning(fault + ": " + request.log);
  if (contents.landmarks.empty())
    callbacks.warning(fmt::format(
        "the map is empty: the {} looks of the drive have {} sightings; --scans chooses the detectors: {}",
        looks.size(), sightings, request.log));
  DriveMapResult result{.crs = contents.crs.id(),
                        .looks = std::ssize(looks),
                        .sightings = stage.counts.in,
                        .rejected = {stage.counts.rejected.begin(), stage.counts.rejected.end()}};
  contents.run = make_single_step_record(std::move(stage), request.log, request.command_line, started);
  const auto written = geodb::write_map(request.map, contents, {.empty_tables = types_of(named)});
  callbacks.summary(
      fmt::format("{} looks, {} sightings, {} of them beyond {} m, {} improbable landmarks removed\n",
                  looks.size(), sightings, made.too_far, request.max_range, made.improbable));
  result.landmarks = {written.begin(), written.end()};
  for (const auto& [type, count] : written) callbacks.summary(fmt::format("    {} {}\n", count, type));
  callbacks.summary(
      fmt::format("{}: {} landmarks in {}\n", request.map, contents.landmarks.size(), contents.crs.id()));
  return result;
}

}  // namespace waymark::workflows
