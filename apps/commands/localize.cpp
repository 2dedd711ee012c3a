// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
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
                      "Read this topic of a bag that has several of odometry or of scans; may be repeated"}
                 .or_else("that with the most messages"),
             Argument{"--robot", "K", &request_.log_format.robot, "Number of the robot in an MRCLAM dataset"},
             Argument{"--ids", "HOW", &ids_, "Whether identities in the log are used for data association"}
                 .one_of({"known", "unknown"})
                 .or_else("known"),
             Argument{"--start", "X,Y,YAW", &request_.start,
                      "Where the robot starts, metres and radians; truth: as the log says; none: unknown"}
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
             Argument{"--crs", "", &request_.in_map_crs, "Write positions in the map's CRS"},
             Argument{"--layers", "MAP.gpkg", &request_.layers,
                      "Map file that gets the layers track and, of a harvester, harvested"}
                 .offering(Offer::file),
             Argument{
                 "--timing", "", &request_.timing,
                 "Write the duration of each update as well (seconds_used), which differs from run to run"},
             Argument{"--live", "SECONDS", &request_.live,
                      "Write --layers while the log plays: so often, in seconds of the log, and after each "
                      "felled tree"}},
        .examples = {
            {"waymark localize site.gpkg drive.jsonl -o track.csv --method pf --start none",
             "Find the robot and follow it"},
            {"waymark localize mrclam.gpkg MRCLAM_Dataset6 --robot 1 --method ekf -o track.csv",
             "A robot of MRCLAM"},
            {"waymark localize site.gpkg drive.csv --columns "
             "t=stamp,v=speed/3.6,omega=rad(rate),bearing=b,range=r "
             "-o track.tum",
             "A CSV log in km/h and degrees; a track for other tools"},
            {"waymark localize site.gpkg recording.mcap --start 0,0,0 -o track.csv", "A recording of ROS 2"},
            {"waymark evaluate track track.csv --truth MRCLAM_Dataset6 --robot 1",
             "The errors of that track"}}};
  }

  int run(const Session& session) override {
    request_.use_identities = ids_ == "known";
    request_.threads = session.threads;
    request_.command_line = session.command_line;
    if (list_) std::cout << workflows::localize_settings(request_);
    if (list_ && (request_.map.empty() || request_.log.empty() || request_.output.empty())) return 0;
    const workflows::LocalizeResult result = workflows::localize(request_, console_callbacks(session));
    summarize(result.track);
    return 0;
  }

 private:
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
    const auto lost = std::ranges::count(track.rows, true, &localization::TrackRow::lost);
    if (lost) {
      const auto first = std::ranges::find(track.rows, true, &localization::TrackRow::lost);
      log_warning(fmt::format("lost in {} of {} rows, first at {:.3f} s", lost, track.rows.size(), first->t));
    }
  }

  workflows::LocalizeRequest request_;
  std::string ids_ = "known";
  bool list_ = false;
};

}  // namespace

void register_command_localize(CommandTable& commands);
void register_command_localize(CommandTable& commands) {
  commands.add<Localize>();
}

}  // namespace waymark::apps
