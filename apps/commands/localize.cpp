// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "apps/log.hpp"
#include "workflows/localization/localize.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

class Localize final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "localize",
        .group = Group::use,
        .summary = "Follow a robot through a map by its log",
        .about =
            "Writes the pose of the robot after each event of the log, with covariances. Methods: " +
            workflows::describe_localize_methods() +
            ". With --ids unknown landmarks are associated by type, position and features.\n\n"
            "Metres are those of the map's east-north-up frame about the middle of its landmarks; in a local "
            "CRS, its own coordinates. --crs writes coordinates of the map's CRS.",
        .arguments =
            {Argument{"", "MAP.gpkg", &request_.map,
                      "Map to use; it is not changed, unless --update-map asks for it; none: no map, for "
                      "slam, graph and odometry"}
                 .needed()
                 .offering(Offer::file),
             Argument{"", "LOG", &request_.log, "Log of the robot: a file, or the folder of a dataset"}
                 .needed()
                 .offering(Offer::file),
             Argument{"-o,--output", "TRACK", &request_.output,
                      "Track to write: .csv, .gpkg, .tum, .kitti or .g2o"}
                 .needed()
                 .offering(Offer::file),
             Argument{"--method", "NAME", &request_.method, "How to localize"}
                 .one_of(workflows::localize_methods())
                 .or_else("ekf"),
             Argument{"--sensor", "NAME|FILE", &request_.sensor,
                      "Sensor profile, built-in or FILE.json: eq. 8 for --set quality=paper and maps without "
                      "confidence; its range, view and detection for --set expect_unseen=true; its standard "
                      "deviations for sightings without any. map: the profile that the map records"}
                 .offering(workflows::all_sensors().names()),
             Argument{"--min-confidence", "P", &request_.min_confidence,
                      "Use only landmarks that exist with at least this probability, 0 to 1"}
                 .or_else("0"),
             Argument{"--seed", "N", &request_.seed, "Seed of all random numbers"}.or_else("1"),
             Argument{"--log-format", "FORMAT", &request_.log_format.format, "Format of the log"}
                 .one_of({"waymark", "csv", "mrclam", "victoria-park", "carmen", "rosbag2", "mcap", "isam",
                          "g2o", "toro", "points"})
                 .or_else("recognised by the files"),
             Argument{"--columns", "TARGET=EXPRESSION,...", &request_.log_format.columns,
                      "What the columns of a CSV log are, e.g. t=stamp/1000,v=speed,omega=rad(rate)"},
             Argument{"--topic", "NAME", &request_.log_format.topics,
                      "Read this topic of a bag that has several of its type; may be repeated"}
                 .or_else("that with the most messages"),
             Argument{"--robot", "K", &request_.log_format.robot, "Number of the robot in an MRCLAM dataset"},
             Argument{"--ids", "HOW", &ids_, "Whether identities in the log are used for data association"}
                 .one_of({"known", "unknown"})
                 .or_else("known"),
             Argument{"--start", "X,Y,YAW[,T]", &request_.start,
                      "Where the robot starts, metres and radians, or was at T seconds of the log; truth: as "
                      "the log says; none: unknown"}
                 .offering({"truth", "none"})
                 .or_else("truth, or the log's start, or none for pf"),
             Argument{"--write-map", "OUT.gpkg", &request_.write_map,
                      "slam, graph: write an updated copy of the map; MAP is not changed"}
                 .offering(Offer::file),
             Argument{"--update-map", "", &request_.update_map,
                      "slam, graph: change MAP itself; `waymark restore MAP` undoes it"},
             Argument{"--set", "OPTION=VALUE", &request_.set,
                      "Change a setting of the method; may be repeated"},
             Argument{"--settings", "", &list_,
                      "List all settings of the method with their values; needs no map and no log"}
                 .alone(),
             Argument{
                 "--dem", "DEM...", &request_.dem,
                 "Ground of the map: gives the track its height, roll and pitch, and the search skylines"}
                 .offering(Offer::file)
                 .or_else("the map's own, if it has one"),
             Argument{"--crs", "", &request_.in_map_crs,
                      "Write positions and yaws of a .csv in the map's CRS"},
             Argument{"--layers", "MAP.gpkg", &request_.layers,
                      "Map file that gets the layers track and, of a harvester, harvested"}
                 .offering(Offer::file),
             Argument{
                 "--timing", "", &request_.timing,
                 "Write the duration of each update as well (seconds_used), which differs from run to run"},
             Argument{"--live", "SECONDS", &request_.live,
                      "Write --layers while the log plays: so often, in seconds of the log, and after each "
                      "felled tree"},
             format_option(&format_)},
        .examples = {{"waymark localize site.gpkg drive.jsonl -o track.csv --method pf --start none",
                      "Find the robot and follow it"},
                     {"waymark localize mrclam.gpkg MRCLAM_Dataset6 --robot 1 --method ekf -o track.csv",
                      "A robot of MRCLAM"},
                     {"waymark localize site.gpkg drive.csv --columns "
                      "t=stamp,v=speed/3.6,omega=rad(rate),bearing=b,range=r "
                      "-o track.tum",
                      "A CSV log in km/h and degrees; a track for other tools"},
                     {"waymark localize site.gpkg recording.mcap --start 0,0,0 -o track.csv",
                      "A recording of ROS 2"},
                     {"waymark evaluate track track.csv --truth MRCLAM_Dataset6 --robot 1",
                      "The errors of that track"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    request_.use_identities = ids_ == "known";
    request_.threads = session.threads;
    request_.command_line = session.command_line;
    const bool json = format_ == "json";
    if (list_ && !json) std::cout << workflows::localize_settings(request_);
    if (list_ && (request_.map.empty() || request_.log.empty() || request_.output.empty())) {
      if (json) print_values({}, workflows::localize_settings_json(request_));
      return 0;
    }
    const workflows::LocalizeResult result =
        workflows::localize(request_, console_callbacks(session, format_));
    summarize(result.track);
    if (json) print_values(values_of(result.track), result.settings_json);
    return 0;
  }

 private:
  using Values = std::vector<std::pair<std::string, ResultValue>>;

  static std::vector<ResultKey> result_keys() {
    return {
        {"track", ResultKind::text, "Track that was written"},
        {"map", ResultKind::text, "Map that was written or updated; null: none"},
        {"rows", ResultKind::integer, "Poses of the track"},
        {"sightings", ResultKind::counts,
         "Sightings by outcome: matched; unsound (not a usable number); unknown_type (the map has none); "
         "nothing_near; features_differ; too_far (outside the gate); ambiguous; taken (its landmark matches "
         "another)"},
        {"fixes", ResultKind::integer, "Readings of GNSS and compass"},
        {"fixes_rejected", ResultKind::integer, "Those of them that were not used"},
        {"identified", ResultKind::integer, "Matches whose landmark the log names"},
        {"wrong", ResultKind::integer, "Those of them with another landmark"},
        {"lost_rows", ResultKind::integer, "Poses while the robot was lost"},
        {"first_lost_s", ResultKind::number, "Time of the first of them; null: none"},
        {"found_s", ResultKind::number,
         "Time of the last pose found in the whole map without a start, or after the robot was lost; null: "
         "none"},
        {"found_x_m", ResultKind::number, "That pose, x in the map frame"},
        {"found_y_m", ResultKind::number, "That pose, y in the map frame"},
        {"found_yaw_rad", ResultKind::number, "That pose, yaw from the map's x towards y"},
        {"found_covariance", ResultKind::object, "Its covariance: xx, xy, yy (m2), xyaw, yyaw, yawyaw"},
        {"wrong_probability", ResultKind::number,
         "Probability that this pose, or the best one of the last search, is wrong; null: no search, or by "
         "ranges"},
        {"search_reason", ResultKind::text, "Why the searches found no pose; null: one did, or no search"},
        {"end_s", ResultKind::number, "Time of the last pose"},
        {"end_x_m", ResultKind::number, "Last pose, x in the map frame"},
        {"end_y_m", ResultKind::number, "Last pose, y in the map frame"},
        {"end_yaw_rad", ResultKind::number, "Last pose, yaw from the map's x towards y"},
        {"sensor_place", ResultKind::object,
         "Estimated place of the sensors on the robot beside that of the log: forward_m, left_m, yaw_rad, "
         "and "
         "their deviations forward_sd_m, left_sd_m, yaw_sd_rad; null: not estimated (--set mount_sd)"},
        {"time_per_update_us", ResultKind::number,
         "Mean duration of an update, microseconds; differs from run "
         "to run; null: no updates"},
        {"chi2", ResultKind::number, "Sum of squared whitened errors of the graph; null: no graph, as below"},
        {"residuals", ResultKind::integer, "Errors that the graph adjusts"},
        {"unknowns", ResultKind::integer, "Parameters of the graph"},
        {"converged", ResultKind::flag, "Whether the adjustment converged"},
        {"settings", ResultKind::object,
         "Settings of the method by name; `waymark localize --settings` explains "
         "them"}};
  }

  Values values_of(const localization::Track& track) const {
    std::map<std::string, std::int64_t> sightings;
    for (int v = 0; v < localization::kVerdicts; ++v)
      sightings[std::string(localization::verdict_name(static_cast<localization::Verdict>(v)))] =
          track.verdicts[static_cast<std::size_t>(v)];
    const auto lost = std::ranges::find(track.rows, true, &localization::TrackRow::lost);
    Values values{{"track", request_.output},
                  {"map", text_or_null(request_.update_map ? request_.map : request_.write_map)},
                  {"rows", static_cast<std::int64_t>(track.rows.size())},
                  {"sightings", sightings},
                  {"fixes", track.fixes},
                  {"fixes_rejected", track.fixes_rejected},
                  {"identified", track.named},
                  {"wrong", track.wrong},
                  {"lost_rows", std::ranges::count(track.rows, true, &localization::TrackRow::lost)}};
    if (lost != track.rows.end()) values.emplace_back("first_lost_s", lost->t);
    if (track.search) add_search(*track.search, values);
    if (!track.rows.empty()) {
      const localization::TrackRow& end = track.rows.back();
      values.insert(values.end(), {{"end_s", end.t},
                                   {"end_x_m", end.at.pose.x},
                                   {"end_y_m", end.at.pose.y},
                                   {"end_yaw_rad", end.at.pose.yaw}});
    }
    if (track.mount) {
      const Eigen::Vector3d sd = track.mount->covariance.diagonal().cwiseSqrt();
      values.emplace_back("sensor_place", ResultJson{result_object({{"forward_m", track.mount->pose.x},
                                                                    {"left_m", track.mount->pose.y},
                                                                    {"yaw_rad", track.mount->pose.yaw},
                                                                    {"forward_sd_m", sd[0]},
                                                                    {"left_sd_m", sd[1]},
                                                                    {"yaw_sd_rad", sd[2]}})});
    }
    if (track.updates)
      values.emplace_back("time_per_update_us", 1e6 * track.seconds / static_cast<double>(track.updates));
    if (track.graph)
      values.insert(values.end(), {{"chi2", track.graph->chi2},
                                   {"residuals", track.graph->residuals},
                                   {"unknowns", track.graph->unknowns},
                                   {"converged", track.graph->converged}});
    return values;
  }

  static void add_search(const localization::PoseSearchRecord& search, Values& values) {
    if (search.wrong_probability) values.emplace_back("wrong_probability", *search.wrong_probability);
    if (!search.t) {
      values.emplace_back("search_reason", text_or_null(search.reason));
      return;
    }
    const Eigen::Matrix3d& c = search.at.covariance;
    values.insert(values.end(), {{"found_s", *search.t},
                                 {"found_x_m", search.at.pose.x},
                                 {"found_y_m", search.at.pose.y},
                                 {"found_yaw_rad", search.at.pose.yaw},
                                 {"found_covariance", ResultJson{result_object({{"xx", c(0, 0)},
                                                                                {"xy", c(0, 1)},
                                                                                {"yy", c(1, 1)},
                                                                                {"xyaw", c(0, 2)},
                                                                                {"yyaw", c(1, 2)},
                                                                                {"yawyaw", c(2, 2)}})}}});
  }

  /// Prints the result; keys without a value are null.
  static void print_values(Values values, const std::string& settings) {
    values.emplace_back("settings", ResultJson{settings});
    const std::vector<ResultKey> keys = result_keys();
    for (const ResultKey& key : keys)
      if (std::ranges::find(values, key.name, &Values::value_type::first) == values.end())
        values.emplace_back(key.name, ResultValue());
    print_result(keys, values);
  }

  void summarize(const localization::Track& track) const {
    std::vector<std::string> parts;
    for (int v = 0; v < localization::kVerdicts; ++v)
      if (const auto count = track.verdicts[static_cast<std::size_t>(v)])
        parts.push_back(
            fmt::format("{} {}", count, localization::wording(static_cast<localization::Verdict>(v))));
    log_summary(fmt::format("{}: {} rows\n", request_.output, track.rows.size()));
    if (!parts.empty()) log_summary(fmt::format("sightings: {}\n", fmt::join(parts, ", ")));
    if (track.fixes)
      log_summary(fmt::format("GNSS and compass readings: {}, {} of them not used\n", track.fixes,
                              track.fixes_rejected));
    if (track.named && ids_ == "unknown")
      log_summary(
          fmt::format("wrong matches, by the identities in the log: {} of {}\n", track.wrong, track.named));
    if (track.updates)
      log_summary(
          fmt::format("{:.1f} us per update\n", 1e6 * track.seconds / static_cast<double>(track.updates)));
    if (track.mount) {
      const Eigen::Vector3d sd = track.mount->covariance.diagonal().cwiseSqrt();
      log_summary(
          fmt::format("sensors, beside their place in the log: {:.3f} m forward, {:.3f} m left, turned by "
                      "{:.4f}; standard "
                      "deviations {:.2g}, {:.2g} m, {:.2g}\n",
                      track.mount->pose.x, track.mount->pose.y, track.mount->pose.yaw, sd[0], sd[1], sd[2]));
    }
    if (track.search && track.search->t) {
      const localization::PoseEstimate& at = track.search->at;
      log_summary(fmt::format(
          "found at {:.3f} s: x {:.2f}, y {:.2f} m, yaw {:.4f}; standard deviations {:.2g}, {:.2g} m, "
          "{:.2g}{}\n",
          *track.search->t, at.pose.x, at.pose.y, at.pose.yaw, std::sqrt(at.covariance(0, 0)),
          std::sqrt(at.covariance(1, 1)), std::sqrt(at.covariance(2, 2)),
          track.search->wrong_probability
              ? fmt::format("; wrong with a probability of {:.2g}", *track.search->wrong_probability)
              : ""));
    } else if (track.search && !track.rows.empty() && track.rows.back().lost) {
      log_warning("the robot is not found: " + track.search->reason);
    }
    const auto lost = std::ranges::count(track.rows, true, &localization::TrackRow::lost);
    if (lost) {
      const auto first = std::ranges::find(track.rows, true, &localization::TrackRow::lost);
      log_warning(fmt::format("lost in {} of {} rows, first at {:.3f} s", lost, track.rows.size(), first->t));
    }
  }

  workflows::LocalizeRequest request_;
  std::string ids_ = "known", format_ = "text";
  bool list_ = false;
};

}  // namespace

void register_command_localize(CommandTable& commands);
void register_command_localize(CommandTable& commands) {
  commands.add<Localize>();
}

}  // namespace waymark::apps
