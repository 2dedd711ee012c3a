// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "apps/command.hpp"
#include "apps/drive_layers.hpp"
#include "apps/localize_method.hpp"
#include "apps/log.hpp"
#include "apps/parse.hpp"
#include "apps/registries.hpp"
#include "apps/session.hpp"
#include "core/error.hpp"
#include "exporters/track_file.hpp"
#include "importers/logs/import_log.hpp"

namespace waymark {
namespace {

class Localize final : public Command {
 public:
  Localize() { register_methods(methods_); }

  CommandSpec describe() override {
    return {
        .name = "localize",
        .group = Group::use,
        .summary = "Follow a robot through a map by its log",
        .about =
            "Writes where the robot was after each event of the log, with covariances. Methods: " +
            methods_.summaries() +
            ". With --ids unknown the landmarks are recognised by type, place and features.\n\n"
            "Metres are those of the map's east-north-up frame about the middle of its landmarks; of a local "
            "CRS, its own coordinates. --crs writes coordinates of the map's CRS.",
        .arguments =
            {Argument{"", "MAP.gpkg", &map_,
                      "Map to use; it is not changed, unless --update-map asks for it; none: no map, for "
                      "slam, graph and odometry"}
                 .needed()
                 .offering(Offer::file),
             Argument{"", "LOG", &log_, "Log of the robot: a file, or the folder of a dataset"}
                 .needed()
                 .offering(Offer::file),
             Argument{"-o,--output", "TRACK", &output_, "Track to write, .csv or .gpkg"}.needed().offering(
                 Offer::file),
             Argument{"--method", "NAME", &method_, "How to localize"}
                 .one_of(methods_.names())
                 .or_else("ekf"),
             Argument{"--sensor", "NAME", &sensor_,
                      "Sensor whose view of the landmarks' quality counts (eq. 8)"}
                 .offering(all_sensors().names()),
             Argument{"--seed", "N", &settings_.particles.seed, "Seed of all random numbers"}.or_else("1"),
             Argument{"--log-format", "FORMAT", &how_.format, "Format of the log"}
                 .one_of({"waymark", "mrclam", "victoria-park", "isam", "g2o", "toro"})
                 .or_else("recognised by what is there"),
             Argument{"--robot", "K", &how_.robot, "Which robot of an MRCLAM dataset"},
             Argument{"--ids", "HOW", &ids_, "Whether landmarks that say who they are are believed"}
                 .one_of({"known", "unknown"})
                 .or_else("known"),
             Argument{"--start", "X,Y,YAW", &start_,
                      "Where the robot starts, metres and radians; truth: as the log says; none: unknown"}
                 .offering({"truth", "none"})
                 .or_else("truth, or the log's start, or none for pf"),
             Argument{"--write-map", "OUT.gpkg", &write_map_,
                      "slam, graph: write the map with what the drive taught; MAP stays as it is"}
                 .offering(Offer::file),
             Argument{"--update-map", "", &update_map_,
                      "slam, graph: change MAP itself; `waymark restore MAP` takes it back"},
             Argument{"--set", "OPTION=VALUE", &sets_, "Change a setting of the method; may be repeated"},
             Argument{"--settings", "", &list_, "Write the track, and list all settings with their defaults"},
             Argument{
                 "--dem", "DEM...", &dem_,
                 "Ground of the map: gives the track its height, roll and pitch, and the search skylines"}
                 .offering(Offer::file)
                 .or_else("the map's own, if it has one"),
             Argument{"--crs", "", &in_crs_, "Write positions in the map's CRS"},
             Argument{"--layers", "MAP.gpkg", &layers_,
                      "Map file that gets the layers track and, of a harvester, harvested"}
                 .offering(Offer::file),
             Argument{"--timing", "", &timing_,
                      "Write how long each update took, too (seconds_used); no two such files are alike"},
             Argument{"--live", "SECONDS", &live_,
                      "Write --layers while the log plays: so often, in seconds of the log, and after each "
                      "felled tree"}},
        .examples = {
            {"waymark localize site.gpkg drive.jsonl -o track.csv --method pf --start none",
             "Find the robot and follow it"},
            {"waymark localize mrclam.gpkg MRCLAM_Dataset6 --robot 1 --method ekf -o track.csv",
             "A robot of MRCLAM"},
            {"waymark evaluate track track.csv --truth MRCLAM_Dataset6 --robot 1", "How well that went"}}};
  }

  int run(const Session& session) override {
    const std::filesystem::path out(output_);
    if (out.extension() != ".csv" && out.extension() != ".gpkg")
      throw Error(ErrorCode::usage, "a track is written as .csv or .gpkg", output_, "e.g. -o track.csv");
    LocalizeMethod& method = methods_.find(method_);
    check_map_output(method);
    const DescribeOptions options = [&](OptionVisitor& visitor) {
      settings_.describe(visitor);
      method.describe(visitor);
    };
    for (const std::string& setting : sets_) set_option(options, setting);
    settings_.identification.use_identities = ids_ == "known";
    settings_.particles.threads = session.threads;
    const SensorProfile* sensor = sensor_.empty() ? nullptr : &all_sensors().at(sensor_);
    OpenedMap opened = map_ == "none" && !method.needs_map()
                           ? no_robot_map()
                           : open_robot_map(map_, sensor, !method.needs_map());
    const RobotMap map = opened.map;
    RobotLog log = import_log(log_, map.types(), how_);
    check_place(log, map);
    place_in(log, map.frame);
    if (map.unsound_covariances)
      log_warning(
          fmt::format("{} landmarks have a covariance that is not positive definite; it is mended: {}",
                      map.unsound_covariances, map_));
    for (const std::string& remark : log.remarks) log_warning(remark + ": " + log_);
    if (log.events.empty())
      throw Error(ErrorCode::input, "the log has no readings", log_,
                  "docs/log_format.md says what a log holds");

    const std::optional<PoseEstimate> start = start_of(log, method);
    if (start) check_distance(*start, map);
    LocalizeTask task{
        .map_file = map_,
        .log_file = log_,
        .log = log,
        .map = std::move(opened),
        .start = start,
        .settings = settings_,
        .sensor = sensor,
        .ground = open_ground(map, dem_),
        .command_line = session.command_line,
        .write_map = write_map_,
        .update_map = update_map_,
        .stem_type = map.types().find("tree") ? std::optional<TypeId>(map.types().id("tree")) : std::nullopt};
    if (live_ != 0 && (layers_.empty() || !(live_ > 0)))
      throw Error(ErrorCode::usage, "--live takes the seconds between two writings of --layers", "--live",
                  "e.g. --layers MAP.gpkg --live 10");
    if (live_ > 0) task.watch = LiveLayers(layers_, log, map.frame, live_);
    const Track track = method.run(task);

    TrackOutput form{.frame = in_crs_ ? &map.frame : nullptr, .crs = &map.crs(), .timing = timing_};
    if (out.extension() == ".gpkg") {
      form.frame = &map.frame;
      write_track_geopackage(out, track, form);
    } else {
      write_track_csv(out, track, form);
    }
    if (!layers_.empty()) write_drive_layers(layers_, log, track, map.frame);
    tell(track);
    if (list_) say(options_as_text(options));
    return 0;
  }

 private:
  void check_map_output(const LocalizeMethod& method) const {
    if (write_map_.empty() && !update_map_) return;
    const char* option = update_map_ ? "--update-map" : "--write-map";
    if (!method.makes_map())
      throw Error(ErrorCode::usage, fmt::format("--method {} does not change maps", method.name()), option,
                  "use --method slam or graph");
    if (update_map_ && !write_map_.empty())
      throw Error(ErrorCode::usage, "--update-map and --write-map exclude each other", "", "give one");
    if (update_map_ && map_ == "none")
      throw Error(ErrorCode::usage, "there is no map to update", option, "use --write-map OUT.gpkg");
    if (!write_map_.empty() && std::filesystem::path(write_map_).extension() != ".gpkg")
      throw Error(ErrorCode::usage, "a map is written as .gpkg", write_map_, "e.g. --write-map map.gpkg");
  }

  void check_place(const RobotLog& log, const RobotMap& map) const {
    if (log.crs.empty()) return;
    const Crs of_log = Crs::from_text(log.crs);
    if (of_log.body().name != map.crs().body().name)
      throw Error(ErrorCode::input,
                  fmt::format("the log is of {}, the map of {}", body_of(of_log), body_of(map.crs())), log_,
                  "use a map of the same body");
    if (log.in_crs && !of_log.same_as(map.crs()))
      throw Error(ErrorCode::input,
                  fmt::format("the log's positions are in {}, the map is in {}", of_log.id(), map.crs().id()),
                  log_, "use a map in that CRS: waymark export MAP OUT --crs ...");
  }

  static std::string body_of(const Crs& crs) {
    return crs.body().name.empty() ? "no body (a local frame)" : crs.body().name;
  }

  void check_distance(const PoseEstimate& start, const RobotMap& map) const {
    if (map.bounds.isEmpty()) return;
    const double away = map.bounds.exteriorDistance(start.pose.at());
    if (away > std::max(1000.0, map.bounds.diagonal().norm()))
      throw Error(
          ErrorCode::input,
          fmt::format("the robot starts {:.1f} km from the nearest landmark of the map", away / 1000), log_,
          "is it the right map, and is the start in the map's frame (or the log's \"frame\" \"crs\")?");
  }

  std::optional<PoseEstimate> start_of(const RobotLog& log, const LocalizeMethod& method) const {
    PoseEstimate start;
    start.covariance.diagonal() << settings_.start_sd * settings_.start_sd,
        settings_.start_sd * settings_.start_sd, settings_.start_yaw_sd * settings_.start_yaw_sd;
    const StartNeed need = method.start();
    if (need == StartNeed::ignored) return {};
    if (start_ == "none") {
      if (need == StartNeed::needed)
        throw Error(ErrorCode::usage, "--method " + method_ + " must know where the robot starts",
                    "--start none", "give --start X,Y,YAW, or use --method pf");
      return {};
    }
    const bool from_truth = start_.empty() || start_ == "truth";
    if (!from_truth) {
      const auto words = numbers(start_);
      if (!(std::abs(words[2]) <= 12.6))
        throw Error(ErrorCode::usage, fmt::format("the yaw of --start is {}: angles are radians", words[2]),
                    "--start " + start_, "e.g. 1.57 for north");
      start.pose = {words[0], words[1], wrapped(words[2])};
      return start;
    }
    if (!log.truth.empty()) {
      const auto known = pose_at(log.truth, log.events.front().t, 5);
      start.pose = known ? *known : log.truth.front().pose;
      return start;
    }
    if (log.start && start_.empty()) {
      start.pose = *log.start;
      const bool told =
          std::ranges::any_of(sets_, [](const std::string& s) { return s.starts_with("start_"); });
      if (log.start_sd > 0 && !told)
        start.covariance.diagonal() << log.start_sd * log.start_sd, log.start_sd * log.start_sd,
            log.start_yaw_sd * log.start_yaw_sd;
      return start;
    }
    if (need != StartNeed::needed && start_.empty()) return {};
    throw Error(ErrorCode::input, "nothing says where the robot starts", log_,
                "give --start X,Y,YAW (metres and radians), or use --method pf");
  }

  static std::vector<double> numbers(const std::string& text) {
    std::vector<double> all;
    std::size_t from = 0;
    while (from <= text.size()) {
      const std::size_t comma = std::min(text.find(',', from), text.size());
      all.push_back(to_number("each of X,Y,YAW of --start", text.substr(from, comma - from)));
      from = comma + 1;
    }
    if (all.size() != 3)
      throw Error(ErrorCode::usage, "--start takes X,Y,YAW, truth or none, is '" + text + "'", "",
                  "e.g. --start 12.5,-3,1.57");
    return all;
  }

  void tell(const Track& track) const {
    std::vector<std::string> parts;
    for (int v = 0; v < kVerdicts; ++v)
      if (const auto count = track.verdicts[static_cast<std::size_t>(v)])
        parts.push_back(fmt::format("{} {}", count, wording(static_cast<Verdict>(v))));
    say(fmt::format("{}: {} rows\n", output_, track.rows.size()));
    if (!parts.empty()) say(fmt::format("sightings: {}\n", fmt::join(parts, ", ")));
    if (track.fixes)
      say(fmt::format("GNSS and compass readings: {}, of which {} were not used\n", track.fixes,
                      track.fixes_rejected));
    if (track.named && ids_ == "unknown")
      say(fmt::format("wrong matches, by the identities in the log: {} of {}\n", track.wrong, track.named));
    if (track.updates)
      say(fmt::format("{:.1f} us per update\n", 1e6 * track.seconds / static_cast<double>(track.updates)));
    const auto lost = std::ranges::count(track.rows, true, &TrackRow::lost);
    if (lost) {
      const auto first = std::ranges::find(track.rows, true, &TrackRow::lost);
      log_warning(fmt::format("lost in {} of {} rows, first at {:.3f} s", lost, track.rows.size(), first->t));
    }
  }

  std::string map_, log_, output_, layers_, method_ = "ekf", sensor_, ids_ = "known", start_;
  std::string write_map_;
  bool update_map_ = false;
  double live_ = 0;
  bool timing_ = false;
  LogImport how_;
  std::vector<std::string> sets_, dem_;
  bool in_crs_ = false, list_ = false;
  LocalizeSettings settings_;
  MethodTable methods_;
};

}  // namespace

void register_command_localize(CommandTable& commands);
void register_command_localize(CommandTable& commands) {
  commands.add<Localize>();
}

}  // namespace waymark
