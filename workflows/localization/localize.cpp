// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/localize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>

#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/options/option_reader.hpp"
#include "exporters/vector/track_file.hpp"
#include "exporters/vector/track_formats.hpp"
#include "geodb/validate_map.hpp"
#include "localization/detectors/detected_types.hpp"
#include "localization/replay_log.hpp"
#include "localization/robot_log.hpp"
#include "workflows/localization/drive_layers.hpp"
#include "workflows/localization/exchanged_sides.hpp"
#include "workflows/localization/localize_method.hpp"
#include "workflows/localization/log_without_landmarks.hpp"
#include "workflows/localization/mirrored_log.hpp"
#include "workflows/parse_number.hpp"
#include "workflows/registries.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::workflows {
namespace {

std::optional<exporters::TrackFormat> pose_format(const std::string& output) {
  const std::string extension = std::filesystem::path(output).extension();
  if (extension == ".tum") return exporters::TrackFormat::tum;
  if (extension == ".kitti") return exporters::TrackFormat::kitti;
  if (extension == ".g2o") return exporters::TrackFormat::g2o;
  return {};
}

void check_track_output(const std::string& output, bool in_map_crs) {
  const std::filesystem::path file(output);
  if (in_map_crs && pose_format(output))
    throw Error(ErrorCode::usage, "poses of TUM, KITTI and g2o are metres of the map frame, not of its CRS",
                output, "leave --crs out, or write a .csv or .gpkg");
  if (file.extension() != ".csv" && file.extension() != ".gpkg" && !pose_format(output))
    throw Error(ErrorCode::usage, "a track is written as .csv, .gpkg, .tum, .kitti or .g2o", output,
                "e.g. -o track.csv");
}

void check_written_map(const LocalizeRequest& request, const LocalizeMethod& method) {
  if (request.write_map.empty() && !request.update_map) return;
  const char* option = request.update_map ? "--update-map" : "--write-map";
  if (!method.updates_map())
    throw Error(ErrorCode::usage, fmt::format("--method {} does not change maps", method.name()), option,
                "use --method slam, graph or beacons");
  if (request.update_map && !request.write_map.empty())
    throw Error(ErrorCode::usage, "--update-map and --write-map exclude each other", "", "give one");
  if (request.update_map && request.map == "none")
    throw Error(ErrorCode::usage, "there is no map to update", option, "use --write-map OUT.gpkg");
  if (!request.write_map.empty() && std::filesystem::path(request.write_map).extension() != ".gpkg")
    throw Error(ErrorCode::usage, "a map is written as .gpkg", request.write_map,
                "e.g. --write-map map.gpkg");
}

std::string body_name(const Crs& crs) {
  return crs.body().name.empty() ? "no body (a local frame)" : crs.body().name;
}

/// Throws if log and map are of different bodies or, for coordinates in a CRS, of different CRSs.
void check_crs(const localization::RobotLog& log, const RobotMap& map, const std::string& log_file) {
  if (log.crs.empty()) return;
  const Crs log_crs = Crs::from_text(log.crs);
  if (log_crs.body().name != map.crs().body().name)
    throw Error(ErrorCode::input,
                fmt::format("the log is of {}, the map of {}", body_name(log_crs), body_name(map.crs())),
                log_file, "use a map of the same body");
  if (log.in_crs && !log_crs.same_as(map.crs()))
    throw Error(ErrorCode::input,
                fmt::format("the log's positions are in {}, the map is in {}", log_crs.id(), map.crs().id()),
                log_file, "use a map in that CRS: waymark export MAP OUT --crs ...");
}

void check_distance(const localization::PoseEstimate& start, const RobotMap& map,
                    const std::string& log_file) {
  if (map.bounds.isEmpty()) return;
  const double away = map.bounds.exteriorDistance(start.pose.at());
  if (away > std::max(1000.0, map.bounds.diagonal().norm()))
    throw Error(ErrorCode::input,
                fmt::format("the robot starts {:.1f} km from the nearest landmark of the map", away / 1000),
                log_file,
                "is it the right map, and is the start in the map's frame (or the log's \"frame\" \"crs\")?");
}

struct StartText {
  localization::Pose2 pose;
  std::optional<double> t;  ///< s, of the log; absent: its first event
};

/// Parses "X,Y,YAW" or "X,Y,YAW,T".
StartText parse_start(const std::string& text) {
  std::vector<double> words;
  std::size_t from = 0;
  while (from <= text.size()) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    words.push_back(parse_number("each of X,Y,YAW,T of --start", text.substr(from, comma - from)));
    from = comma + 1;
  }
  if (words.size() != 3 && words.size() != 4)
    throw Error(ErrorCode::usage, "--start takes X,Y,YAW, X,Y,YAW,T, truth or none, is '" + text + "'", "",
                "e.g. --start 12.5,-3,1.57");
  if (!(std::abs(words[2]) <= 12.6))
    throw Error(ErrorCode::usage, fmt::format("the yaw of --start is {}: angles are radians", words[2]),
                "--start " + text, "e.g. 1.57 for north");
  return {{words[0], words[1], localization::wrap_angle(words[2])},
          words.size() == 4 ? std::optional(words[3]) : std::nullopt};
}

/// Returns the pose at the first event of a log of a robot that was at `later` at time `t`: odometry leads
/// back.
localization::PoseEstimate before_motion(const localization::PoseEstimate& later, double t,
                                         const localization::RobotLog& log,
                                         const localization::ReplayOptions& play) {
  localization::DeadReckoning driven({});
  localization::LogReplay replay(log, driven, play);
  for (const localization::LogEvent& event : log.events) {
    if (event.t > t) break;
    replay.take(event);
    replay.forget_rows();
  }
  const localization::PoseEstimate motion = driven.estimate();
  const localization::Pose2 back = inverse(motion.pose);
  const double c = std::cos(motion.pose.yaw), s = std::sin(motion.pose.yaw);
  Eigen::Matrix3d by_motion;
  by_motion << -c, -s, back.y, s, -c, -back.x, 0, 0, -1;
  return localization::predict_pose(
      later, {.step = back, .covariance = by_motion * motion.covariance * by_motion.transpose()});
}

void check_start_time(double t, const localization::RobotLog& log, const std::string& text) {
  const double first = log.events.front().t, last = log.events.back().t;
  if (!(t >= first && t <= last))
    throw Error(
        ErrorCode::usage,
        fmt::format("the time of --start is {:.3f} s, the log is from {:.3f} to {:.3f} s", t, first, last),
        "--start " + text, "leave the time out for the pose at the first event");
}

Eigen::Matrix3d start_covariance(double sd, double yaw_sd) {
  return Eigen::Vector3d(sd * sd, sd * sd, yaw_sd * yaw_sd).asDiagonal();
}

std::optional<localization::PoseEstimate> choose_start(const LocalizeRequest& request,
                                                       const LocalizeSettings& settings,
                                                       const localization::RobotLog& log,
                                                       StartPolicy policy) {
  if (policy == StartPolicy::ignored) return {};
  if (request.start == "none") {
    if (policy == StartPolicy::required)
      throw Error(ErrorCode::usage, "--method " + request.method + " must know where the robot starts",
                  "--start none", "give --start X,Y,YAW, or use --method pf");
    return {};
  }
  localization::PoseEstimate start{{}, start_covariance(settings.start_sd, settings.start_yaw_sd)};
  if (!request.start.empty() && request.start != "truth") {
    const StartText given = parse_start(request.start);
    start.pose = given.pose;
    if (!given.t) return start;
    check_start_time(*given.t, log, request.start);
    return before_motion(start, *given.t, log, settings.play);
  }
  if (!log.truth.empty()) {
    const auto known = localization::pose_at(log.truth, log.events.front().t, 5);
    start.pose = known ? *known : log.truth.front().pose;
    return known ? start : before_motion(start, log.truth.front().t, log, settings.play);
  }
  if (log.start && request.start.empty()) {
    start.pose = *log.start;
    const bool sd_given =
        std::ranges::any_of(request.set, [](const std::string& s) { return s.starts_with("start_"); });
    if (log.start_sd > 0 && !sd_given) start.covariance = start_covariance(log.start_sd, log.start_yaw_sd);
    return start;
  }
  if (policy == StartPolicy::optional && request.start.empty()) return {};
  throw Error(ErrorCode::input, "the start of the robot is unknown", request.log,
              "give --start X,Y,YAW (metres and radians), or use --method pf");
}

localization::RobotLog read_log(const LocalizeRequest& request, const SensorProfile* sensor,
                                const RobotMap& map, const Callbacks& callbacks) {
  importers::LogImport how = request.log_format;
  if (sensor) how.sensor = sensor->coverage;
  how.held_types = map.held_types;
  localization::RobotLog log = importers::import_log(request.log, map.types(), how);
  check_crs(log, map, request.log);
  localization::convert_to_map_frame(log, map.frame);
  if (map.unsound_covariances)
    callbacks.warning(
        fmt::format("{} landmarks have a covariance that is not positive definite; it is repaired: {}",
                    map.unsound_covariances, request.map));
  for (const std::string& remark : log.remarks) callbacks.warning(remark + ": " + request.log);
  if (log.events.empty())
    throw Error(ErrorCode::input, "the log has no readings", request.log,
                "docs/reference/log_format.md says what a log holds");
  return log;
}

/// Warns if bearings are to be identified and nothing says how far their sensor sees.
void check_reach(const localization::RobotLog& log, const localization::IdentificationOptions& options,
                 const LocalizeRequest& request, const Callbacks& callbacks) {
  if (options.bearing_reach > 0 || options.sensor_range > 0) return;
  std::size_t bearings = 0, all = 0;
  for (const localization::LogEvent& event : log.events)
    if (const auto* seen = std::get_if<localization::SightingSet>(&event.what))
      for (const localization::SeenLandmark& s : seen->sightings)
        ++all, bearings += !s.range && !s.elevation && !(options.use_identities && s.identity);
  if (2 * bearings <= all) return;
  callbacks.warning(fmt::format(
      "{} of {} sightings have no range, and how far the sensor sees is not known: many landmarks lie on a "
      "bearing; give --sensor FILE with coverage.range, or --set bearing_reach=METRES: {}",
      bearings, all, request.log));
}

void write_track(const LocalizeRequest& request, const localization::Track& track, const RobotMap& map) {
  exporters::TrackOutput form{
      .frame = request.in_map_crs ? &map.frame : nullptr, .crs = &map.crs(), .timing = request.timing};
  if (std::filesystem::path(request.output).extension() == ".gpkg") {
    form.frame = &map.frame;
    exporters::write_track_geopackage(request.output, track, form);
  } else if (const auto format = pose_format(request.output)) {
    exporters::write_track_poses(request.output, track, *format);
  } else {
    exporters::write_track_csv(request.output, track, form);
  }
}

localization::TrackWatcher both(localization::TrackWatcher first, localization::TrackWatcher second) {
  if (!first) return second;
  return [=](const localization::Track& track) {
    first(track);
    second(track);
  };
}

/// Runs a method on the beginning of the log, as it is and mirrored. Returns a warning if it fits the map
/// much better mirrored.
std::string find_mirrored(const LocalizeTask& task, const OpenedMap& map, LocalizeMethod& method) {
  const localization::RobotLog start = beginning_of(task.log);
  const auto run = [&](localization::RobotLog log) {
    LocalizeTask other{.map_file = task.map_file,
                       .log_file = task.log_file,
                       .log = log,
                       .map = map,
                       .start = task.start,
                       .settings = task.settings,
                       .sensor = task.sensor,
                       .ground = task.ground,
                       .stem_type = task.stem_type};
    return method.run(other);
  };
  return mirror_warning(run(start), run(mirror_log(start, MirroredPart::sensors)),
                        run(mirror_log(start, MirroredPart::robot)),
                        run(mirror_log(start, MirroredPart::motion)));
}

/// Returns a warning if left and right of the log are exchanged, by the map or by its odometry; else empty.
std::string find_exchanged_sides(const LocalizeRequest& request, const LocalizeTask& task,
                                 LocalizeMethod& method, const localization::Track& track,
                                 const SensorProfile* sensor) {
  // SLAM without a start maps the mirrored world as well as the true one.
  const bool can_be_mirrored = !method.updates_map() || method.start() == StartPolicy::required;
  if (task.start && request.map != "none" && can_be_mirrored && fits_badly(track)) {
    const OpenedMap again =
        open_robot_map(request.map, sensor, !method.requires_map(), request.min_confidence);
    if (std::string fault = find_mirrored(task, again, method); !fault.empty()) return fault;
  }
  return exchanged_sides_warning(task.log, poses_by_odometry(task.log), "the odometry");
}

/// Warns of scans without usable ranges, and of a track that saw no landmark.
void warn_if_blind(const localization::RobotLog& log, const localization::Track& track,
                   const LocalizeRequest& request, const Callbacks& callbacks) {
  for (const std::string& fault : {unusable_ranges_warning(log), dead_reckoning_warning(log, track)})
    if (!fault.empty()) callbacks.warning(fault + ": " + request.log);
}

const MethodTable& method_table() {
  static const MethodTable table = [] {
    MethodTable made;
    register_methods(made);
    return made;
  }();
  return table;
}

/// Returns every setting of the request's method.
std::vector<OptionRow> settings_of(const LocalizeRequest& request) {
  MethodTable methods;
  register_methods(methods);
  LocalizeMethod& method = methods.find(request.method);
  const std::shared_ptr<const SensorProfile> sensor =
      request.sensor.empty() ? nullptr : find_sensor(request.sensor, request.map);
  LocalizeSettings settings = make_settings(request, method, sensor.get(), {});
  const DescribeOptions options = [&](OptionVisitor& visitor) { method.describe_all(settings, visitor); };
  return option_table(options);
}

}  // namespace

LocalizeResult localize(const LocalizeRequest& request, const Callbacks& callbacks) {
  if (!request.output.empty()) check_track_output(request.output, request.in_map_crs);
  MethodTable methods;  // of this call: a method keeps its settings
  register_methods(methods);
  LocalizeMethod& method = methods.find(request.method);
  check_written_map(request, method);
  keep_inputs(request.output, {request.map, request.log, request.sensor, request.layers, request.write_map});
  keep_inputs(request.write_map, {request.map, request.log});
  for (const std::string& output : {request.output, request.write_map}) keep_inputs(output, request.dem);
  const std::shared_ptr<const SensorProfile> sensor =
      request.sensor.empty() ? nullptr : find_sensor(request.sensor, request.map);
  LocalizeSettings settings = make_settings(request, method, sensor.get(), callbacks);
  const DescribeOptions options = [&](OptionVisitor& visitor) { method.describe_all(settings, visitor); };
  check_number("--min-confidence", request.min_confidence, "", {.help = "", .min = 0, .max = 1});
  OpenedMap opened =
      request.map == "none" && !method.requires_map()
          ? make_empty_robot_map()
          : open_robot_map(request.map, sensor.get(), !method.requires_map(), request.min_confidence);
  const RobotMap map = opened.map;
  localization::RobotLog log = read_log(request, sensor.get(), map, callbacks);
  share_odometry_noise(request, options, settings.play, log);
  use_survey_accuracy(map, settings.play);
  check_reach(log, settings.identification, request, callbacks);
  const std::optional<localization::PoseEstimate> start =
      choose_start(request, settings, log, method.start());
  if (start) check_distance(*start, map, request.log);
  LocalizeTask task{.map_file = request.map,
                    .log_file = request.log,
                    .log = log,
                    .map = std::move(opened),
                    .start = start,
                    .settings = settings,
                    .sensor = sensor.get(),
                    .ground = open_terrain(map, request.dem),
                    .command_line = request.command_line,
                    .settings_json = options_as_json(option_table(options)),
                    .write_map = request.write_map,
                    .update_map = request.update_map,
                    .stem_type = localization::detected_types(map.types()).tree,
                    .callbacks = callbacks};
  if (request.live != 0 && (request.layers.empty() || !(request.live > 0)))
    throw Error(ErrorCode::usage, "--live takes the seconds between two writings of --layers", "--live",
                "e.g. --layers MAP.gpkg --live 10");
  if (!request.layers.empty()) geodb::check_before_copy(request.layers);
  if (request.live > 0) task.watch = LiveLayers(request.layers, log, map.frame, request.live);
  if (request.watch) task.watch = both(std::move(task.watch), request.watch);
  LocalizeResult result{.track = method.run(task),
                        .settings = options_as_text(option_table(options)),
                        .settings_json = task.settings_json};
  if (method.name() != "odometry") warn_if_blind(log, result.track, request, callbacks);
  if (method.name() != "odometry")
    if (const std::string fault = find_exchanged_sides(request, task, method, result.track, sensor.get());
        !fault.empty())
      callbacks.warning(fault + ": " + request.log);
  if (!request.output.empty()) write_track(request, result.track, map);
  if (!request.layers.empty()) write_drive_layers(request.layers, log, result.track, map.frame);
  return result;
}

std::string localize_settings(const LocalizeRequest& request) {
  return options_as_text(settings_of(request));
}

std::string localize_settings_json(const LocalizeRequest& request) {
  return options_as_json(settings_of(request));
}

std::vector<std::string> localize_methods() {
  return method_table().names();
}

std::string describe_localize_methods() {
  return method_table().summaries();
}

}  // namespace waymark::workflows
