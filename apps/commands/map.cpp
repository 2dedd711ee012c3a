// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "workflows/mapping/map_drive.hpp"

namespace waymark::apps {
namespace {

class MapDrive final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "map",
        .group = Group::make,
        .summary = "Make a map from a robot's log and its known poses",
        .about =
            "Detects landmarks in the scans of a drive, or takes its sightings, and merges those of one "
            "landmark. "
            "Each landmark has its evidence, its quality and the number of looks that saw it and that could "
            "have. "
            "Poses may cover parts of the drive; the rest is not used.",
        .arguments =
            {Argument{"", "LOG", &request_.log, "Log of the robot: a file, or the folder of a dataset"}
                 .needed()
                 .offering(Offer::file),
             Argument{"-o,--output", "MAP.gpkg", &request_.map, "Map to write"}.needed().offering(
                 Offer::file),
             Argument{"--poses", "TRACK", &request_.poses,
                      "Poses of the robot: .csv with t, x, y, yaw (seconds, metres, radians), or TUM"}
                 .offering(Offer::file)
                 .or_else("the true poses of the log"),
             Argument{"--scans", "NAME,...", &request_.scans,
                      fmt::format("Detectors for laser scans: {}; for 3-D scans: {} (all if none of these is "
                                  "named)",
                                  fmt::join(localization::laser_detectors().names(), ", "),
                                  fmt::join(localization::point_detectors().names(), ", "))}
                 .or_else("walls,wall_lines"),
             Argument{"--max-range", "M", &request_.max_range, "Do not use sightings farther away, metres"}
                 .or_else("20"),
             Argument{"--crs", "CRS", &request_.crs, "CRS of the poses, projected or local"}.or_else(
                 "that of the log's poses, or local"),
             Argument{"--log-format", "FORMAT", &request_.log_format.format, "Format of the log"}
                 .one_of({"waymark", "csv", "mrclam", "victoria-park", "carmen", "rosbag2", "mcap", "points"})
                 .or_else("recognised by the files"),
             Argument{"--columns", "TARGET=EXPRESSION,...", &request_.log_format.columns,
                      "What the columns of a CSV log are, e.g. t=stamp/1000,v=speed,omega=rad(rate)"},
             Argument{"--topic", "NAME", &request_.log_format.topics,
                      "Read this topic of a bag that has several of its type; may be repeated"}
                 .or_else("that with the most messages"),
             Argument{"--robot", "K", &request_.log_format.robot, "Number of the robot in an MRCLAM dataset"},
             format_option(&format_)},
        .examples = {{"waymark map intel.clf --poses corrected.csv -o office.gpkg",
                      "Corners and ends of walls"},
                     {"waymark map drive.jsonl --scans poles -o street.gpkg",
                      "Posts, by the true poses of a simulated drive"},
                     {"waymark map kitti --poses poses.csv --scans poles_3d --max-range 40 -o street.gpkg",
                      "Posts in 3-D scans"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    request_.command_line = session.command_line;
    const workflows::DriveMapResult made =
        workflows::map_drive(request_, console_callbacks(session, format_));
    if (format_ == "json")
      print_result(result_keys(), {{"map", request_.map},
                                   {"crs", made.crs},
                                   {"looks", made.looks},
                                   {"sightings", made.sightings},
                                   {"rejected", made.rejected},
                                   {"landmarks", made.landmarks}});
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"map", ResultKind::text, "Map that was written"},
            {"crs", ResultKind::text, "CRS of the poses and of the map"},
            {"looks", ResultKind::integer, "Scans and sets of sightings at known poses"},
            {"sightings", ResultKind::integer, "Sightings in these looks"},
            {"rejected", ResultKind::counts, "Sightings and landmarks left out, by reason"},
            {"landmarks", ResultKind::counts, "Landmarks by type"}};
  }

  std::string format_ = "text";
  workflows::DriveMapRequest request_;
};

}  // namespace

void register_command_map(CommandTable& commands);
void register_command_map(CommandTable& commands) {
  commands.add<MapDrive>();
}

}  // namespace waymark::apps
