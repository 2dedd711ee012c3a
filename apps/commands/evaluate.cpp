// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <string>
#include <utility>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "apps/score_text.hpp"
#include "core/error.hpp"
#include "workflows/evaluation/evaluate.hpp"
#include "workflows/evaluation/track_study.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

std::vector<Argument> track_arguments(workflows::TrackEvaluation& into,
                                      std::vector<std::string>& more_drives) {
  return {
      Argument{"--align", "HOW", &into.align, "track: how it is aligned with the truth first"}
          .one_of({"none", "se2", "sim2"})
          .or_else("none"),
      Argument{"--log-format", "FORMAT", &into.log_format.format, "track: format of a truth that is a log"}
          .one_of({"waymark", "csv", "mrclam", "victoria-park", "carmen", "rosbag2", "mcap"})
          .or_else("recognised; .csv and .tum are tracks"),
      Argument{"--columns", "TARGET=EXPRESSION,...", &into.log_format.columns,
               "track: what the columns of a truth in a CSV log are, e.g. "
               "t=stamp/1000,truth_x=east,truth_y=north"},
      Argument{"--robot", "K", &into.log_format.robot,
               "track: which robot of an MRCLAM dataset is the truth"},
      Argument{"--picture", "FILE.svg", &into.picture, "track: draw truth, track and their errors"}.offering(
          Offer::file),
      Argument{
          "--map", "MAP", &into.map,
          "track: map that the robot used; it is drawn, and a truth in CRS coordinates is put into its frame"}
          .offering(Offer::file),
      Argument{"--drive", "TRACK=LOG", &more_drives,
               "track: another drive and its truth; the result is a summary over all, --picture their errors "
               "over time; may be repeated"},
      Argument{"--also", "NAME=TRACK", &into.also, "track: another track of the picture; may be repeated"},
      Argument{"--max-gap", "S", &into.max_gap,
               "track: seconds between two true poses that may be interpolated"}
          .or_else("0.5")
          .formerly("--longest-gap")};
}

class Evaluate final : public Command {
 public:
  CommandSpec describe() override {
    CommandSpec spec{
        .name = "evaluate",
        .group = Group::look_up,
        .summary = "Compare a map or a list of detections with the truth",
        .about =
            "Both may be maps, CSV or anything GDAL reads as points. Only numbers are compared, so both "
            "must be in one coordinate system (pixels with pixels, metres with metres). Sizes come from "
            "the column diameter, or radius, or major_axis and minor_axis. Every other column of numbers "
            "that both have is compared as a feature. Confidences, qualities and covariances of the "
            "result are checked against the truth: the expected calibration error and the fraction of "
            "errors inside the 90 % ellipses.\n\n"
            "True objects are matched one to one, largest first, with the nearest detection within 0.75 "
            "diameters (--by overlap: most confident detection first, circles with intersection over "
            "union of 0.5). True objects that no image shows completely, or none larger than --min-"
            "pixels, are not evaluated (columns images and pixels of a testbed's truth), nor are those of "
            "--ignore.",
        .arguments =
            {Argument{"", "WHAT", &what_, "What is compared"}.one_of({"landmarks", "track"}).needed(),
             file_word("RESULT", &landmarks_.result, "Map or table of detected objects"),
             Argument{"--truth", "FILE", &landmarks_.truth, "Map or table of true objects"}
                 .offering(Offer::file)
                 .needed(),
             Argument{"--ignore", "FILE", &landmarks_.ignore,
                      "More true objects: detecting or missing one of these counts neither way"}
                 .offering(Offer::file),
             Argument{"--type", "TYPE", &landmarks_.type, "Compare one landmark type only"}.or_else(
                 "all that the truth has"),
             Argument{"--sensor", "NAME|FILE", &landmarks_.sensor,
                      "landmarks: check the quality of a map as this sensor weighs it (eq. 8); map: the "
                      "profile that the map records"}
                 .offering(workflows::all_sensors().names()),
             Argument{"--by", "RULE", &landmarks_.match_by, "How pairs are found"}
                 .one_of({"distance", "overlap"})
                 .or_else("distance"),
             Argument{"--tolerance", "DIAMETERS", &landmarks_.max_distance, "Largest distance of a pair"}
                 .or_else("0.75")
                 .formerly("--share"),
             Argument{"--min-tolerance", "UNITS", &landmarks_.always_allowed_distance,
                      "Distance that is always allowed"}
                 .or_else("0")
                 .formerly("--least"),
             Argument{"--min-diameter", "UNITS", &landmarks_.min_diameter,
                      "Smaller objects are not evaluated"}
                 .or_else("0"),
             Argument{"--min-pixels", "PIXELS", &landmarks_.min_pixels,
                      "Objects smaller than this in every image are not evaluated"}
                 .or_else("3"),
             Argument{"--size-edges", "D...", &landmarks_.size_edges,
                      "Diameters between which results are reported separately"},
             format_option(&format_)},
        .examples = {
            {"waymark evaluate landmarks mars.gpkg --truth mars/truth.csv --ignore mars/ignored.csv",
             "A landing map against its testbed"},
            {"waymark evaluate landmarks out.csv --truth tile_gt.csv --by overlap --min-diameter 16",
             "Craters of one image against a catalogue, in pixels"},
            {"waymark evaluate track a.csv --truth a.jsonl --drive b.csv=b.jsonl --drive c.csv=c.jsonl",
             "Medians, confidence intervals and consistency over three drives"}}};
    for (Argument& argument : track_arguments(track_, more_drives_)) spec.arguments.push_back(argument);
    return spec;
  }

  int run(const Session& session) override {
    if (what_ == "track" && !landmarks_.sensor.empty())
      throw Error(ErrorCode::usage, "--sensor weighs the quality of landmarks; a track has none", "",
                  "leave it out, or `waymark evaluate landmarks`");
    refuse_options_of_the_other();
    if (what_ == "track") {
      track_.track = landmarks_.result;
      track_.truth = landmarks_.truth;
      if (!more_drives_.empty()) {
        const workflows::TrackStudy study = workflows::evaluate_drives(track_, more_drives_);
        std::cout << (format_ == "json" ? track_study_as_json(study, track_.align)
                                        : track_study_as_text(study, track_.align));
        return 0;
      }
      const localization::TrackScore score = workflows::evaluate(track_);
      std::cout << (format_ == "json" ? track_score_as_json(score, track_.align)
                                      : track_score_as_text(score, track_.align));
      return 0;
    }
    const auto scores = workflows::evaluate(landmarks_, console_callbacks(session));
    std::cout << (format_ == "json" ? scores_as_json(scores) : scores_as_text(scores));
    return 0;
  }

 private:
  void refuse_options_of_the_other() const {
    const workflows::LandmarkEvaluation plain;
    const workflows::TrackEvaluation still;
    const bool is_track = what_ == "track";
    const std::pair<bool, const char*> given[] = {
        {is_track && !landmarks_.ignore.empty(), "--ignore"},
        {is_track && !landmarks_.type.empty(), "--type"},
        {is_track && landmarks_.match_by != plain.match_by, "--by"},
        {is_track && landmarks_.max_distance != plain.max_distance, "--tolerance"},
        {is_track && landmarks_.always_allowed_distance != plain.always_allowed_distance, "--min-tolerance"},
        {is_track && landmarks_.min_diameter != plain.min_diameter, "--min-diameter"},
        {is_track && landmarks_.min_pixels != plain.min_pixels, "--min-pixels"},
        {is_track && !landmarks_.size_edges.empty(), "--size-edges"},
        {!is_track && track_.align != still.align, "--align"},
        {!is_track && !track_.log_format.format.empty(), "--log-format"},
        {!is_track && !track_.log_format.columns.empty(), "--columns"},
        {!is_track && track_.log_format.robot != still.log_format.robot, "--robot"},
        {!is_track && !track_.picture.empty(), "--picture"},
        {!is_track && !track_.map.empty(), "--map"},
        {!is_track && !more_drives_.empty(), "--drive"},
        {!is_track && !track_.also.empty(), "--also"},
        {!is_track && track_.max_gap != still.max_gap, "--max-gap"}};
    for (const auto& [is_given, option] : given)
      if (is_given)
        throw Error(ErrorCode::usage, std::string(option) + " is no option of `evaluate " + what_ + "`", "",
                    is_track ? "leave it out: it compares landmarks" : "leave it out: it compares tracks");
  }

  std::string what_, format_ = "text";
  workflows::LandmarkEvaluation landmarks_;
  workflows::TrackEvaluation track_;
  std::vector<std::string> more_drives_;
};

}  // namespace

void register_command_evaluate(CommandTable& commands);
void register_command_evaluate(CommandTable& commands) {
  commands.add<Evaluate>();
}

}  // namespace waymark::apps
