// SPDX-License-Identifier: Apache-2.0
#include "workflows/viewing/view.hpp"
#include "apps/command.hpp"
#include "apps/console.hpp"

namespace waymark::apps {
namespace {

class View final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "view",
        .group = Group::use,
        .summary = "Write a page that shows a map and drives on it in three dimensions",
        .about =
            "One HTML file with terrain, landmarks, posed images and drives. It needs no network and no "
            "other file, only a browser with WebGL 2. Landmarks are drawn as the solids of their types; a "
            "click shows features with standard deviations, quality, confidence and evidence. Images are "
            "draped on the terrain, with the pyramids of their views. A log and tracks are played back with "
            "covariance ellipses, laser beams and sightings.\n\n"
            "For the folder of a simulated scene, the true landmarks are shown, with its DEM, images and "
            "log. Elevation model and images of a map are those of the run that made it, if the files still "
            "exist. The page has at most 10 MB.",
        .arguments =
            {file_word("MAP|SCENE", &request_.map, "Map (.gpkg), or the folder of a simulated scene"),
             Argument{"-o,--output", "VIEW.html", &request_.output, "Page to write; an older one is replaced"}
                 .needed()
                 .offering(Offer::file),
             Argument{"--log", "LOG", &request_.log, "Log of a drive: true poses, laser scans, sightings"}
                 .offering(Offer::file)
                 .or_else("that of the scene"),
             Argument{"--track", "[NAME=]TRACK", &request_.tracks,
                      "Track of `waymark localize` (.csv or .tum, map frame); may be repeated"}
                 .offering(Offer::file),
             Argument{"--dem", "DEM", &request_.dem, "Elevation model; may be repeated"}
                 .offering(Offer::file)
                 .or_else("that of the map"),
             Argument{"--orthophoto", "FILE", &request_.orthophoto,
                      "Orthophoto on the terrain, in the map's CRS"}
                 .offering(Offer::file)
                 .or_else("shaded relief"),
             Argument{"--cameras", "FILE", &request_.cameras, "Camera file with the poses of images"}
                 .offering(Offer::file)
                 .or_else("the map's images"),
             Argument{"--images", "FOLDER", &request_.images, "Folder of the images of --cameras"}
                 .offering(Offer::folder)
                 .or_else("images, beside the camera file"),
             Argument{"--max-landmarks", "N", &request_.max_landmarks,
                      "Most landmarks drawn, the largest of each type first"}
                 .or_else("24000"),
             Argument{"--title", "TEXT", &request_.title, "Title of the page"}.or_else("the file's name"),
             Argument{"--log-format", "FORMAT", &request_.log_format.format, "Format of the log"}
                 .one_of({"waymark", "csv", "mrclam", "victoria-park", "carmen", "rosbag2", "mcap", "isam",
                          "g2o", "toro", "points"})
                 .or_else("recognised by the files"),
             Argument{"--columns", "TARGET=EXPRESSION,...", &request_.log_format.columns,
                      "What the columns of a CSV log are, e.g. t=stamp/1000,v=speed,omega=rad(rate)"},
             Argument{"--robot", "K", &request_.log_format.robot, "Number of the robot in an MRCLAM dataset"},
             format_option(&format_)},
        .examples = {{"waymark view mars.gpkg -o mars.html", "A landing with its images on the terrain"},
                     {"waymark view mission.gpkg --log mission/log.jsonl --track ekf.csv --track "
                      "odometry.csv -o drive.html",
                      "Play back a drive with two estimates"},
                     {"waymark view forest/ -o forest.html", "The true trees of a simulated forest"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    const workflows::ViewPageResult made =
        workflows::write_view(request_, console_callbacks(session, format_));
    if (format_ == "json")
      print_result(result_keys(), {{"page", request_.output},
                                   {"bytes", made.bytes},
                                   {"landmarks", made.landmarks},
                                   {"images", made.images},
                                   {"tracks", made.tracks},
                                   {"notes", made.notes}});
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"page", ResultKind::text, "Page that was written"},
            {"bytes", ResultKind::integer, "Its size"},
            {"landmarks", ResultKind::counts, "Landmarks drawn, by type"},
            {"images", ResultKind::integer, "Posed images"},
            {"tracks", ResultKind::integer, "Tracks, the true poses of the log among them"},
            {"notes", ResultKind::texts, "What was left out"}};
  }

  std::string format_ = "text";
  workflows::ViewPageRequest request_;
};

}  // namespace

void register_command_view(CommandTable& commands);
void register_command_view(CommandTable& commands) {
  commands.add<View>();
}

}  // namespace waymark::apps
