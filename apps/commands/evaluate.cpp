// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "apps/command.hpp"
#include "apps/evaluate_track.hpp"
#include "apps/registries.hpp"
#include "apps/score_text.hpp"
#include "apps/scored_table.hpp"
#include "core/error.hpp"

namespace waymark {
namespace {

class Evaluate final : public Command {
 public:
  CommandSpec describe() override {
    CommandSpec spec{
        .name = "evaluate",
        .group = Group::look_up,
        .summary = "Compare a map or a list of detections with the truth",
        .about =
            "Both may be maps, CSV or anything GDAL reads as points; only numbers are compared, so both must "
            "be in one coordinate system (pixels with pixels, metres with metres). Sizes come from the "
            "column "
            "diameter, or radius, or major_axis and minor_axis. Every other column of numbers that both have "
            "is compared as a feature. Confidences, qualities and covariances of the result are checked "
            "against what is true: the expected calibration error and the share of errors inside the 90 % "
            "ellipses.\n\n"
            "True things are matched one to one, largest first, with the nearest find within 0.75 diameters "
            "(--by overlap: most confident find first, circles with intersection over union of 0.5). True "
            "things that no image shows wholly, or none larger than --min-pixels, are not asked for (columns "
            "images and pixels of a testbed's truth), nor are those of --ignore.",
        .arguments =
            {Argument{"", "WHAT", &what_, "What is compared"}.one_of({"landmarks", "track"}).needed(),
             file_word("RESULT", &result_, "Map or table of what was found"),
             Argument{"--truth", "FILE", &truth_, "Map or table of what is there"}
                 .offering(Offer::file)
                 .needed(),
             Argument{"--ignore", "FILE", &ignore_,
                      "More true things: finding or missing one of these counts neither way"}
                 .offering(Offer::file),
             Argument{"--type", "TYPE", &type_, "Compare one landmark type only"}.or_else(
                 "all that the truth has"),
             Argument{"--by", "RULE", &by_, "How pairs are found"}
                 .one_of({"distance", "overlap"})
                 .or_else("distance"),
             Argument{"--share", "DIAMETERS", &share_, "Largest distance of a pair"}.or_else("0.75"),
             Argument{"--least", "UNITS", &least_, "Distance that is always allowed"}.or_else("0"),
             Argument{"--min-diameter", "UNITS", &min_diameter_, "Smaller things are not asked for"}.or_else(
                 "0"),
             Argument{"--min-pixels", "PIXELS", &min_pixels_,
                      "Things smaller than this in every image are not asked for"}
                 .or_else("3"),
             Argument{"--size-edges", "D...", &edges_, "Diameters between which results are told apart"},
             Argument{"--format", "FORMAT", &format_, "text or json"}
                 .one_of({"text", "json"})
                 .or_else("text")},
        .examples = {{"waymark evaluate landmarks mars.gpkg --truth mars/truth.csv --ignore mars/ignored.csv",
                      "A landing map against its testbed"},
                     {"waymark evaluate landmarks out.csv --truth tile_gt.csv --by overlap --min-diameter 16",
                      "Craters of one image against a catalogue, in pixels"}}};
    for (Argument& argument : track_arguments(track_)) spec.arguments.push_back(argument);
    return spec;
  }

  int run(const Session&) override {
    if (what_ == "track") {
      std::cout << evaluate_track(result_, truth_, format_, track_);
      return 0;
    }
    if (!(share_ >= 0) || !(least_ >= 0) || !(min_diameter_ >= 0))
      throw Error(ErrorCode::usage, "distances and sizes are not negative", "evaluate landmarks");
    const ScoredTables found = scored_things(result_, type_, 0);
    ScoredTables truth = scored_things(truth_, type_, min_pixels_);
    if (!ignore_.empty())
      for (auto& [type, things] : scored_things(ignore_, type_, 0))
        for (ScoredThing& thing : things) {
          thing.ignored = true;
          truth[type].push_back(thing);
        }
    std::map<std::string, Score> scores;
    MatchRules rules{.by = by_ == "overlap" ? MatchRules::By::overlap : MatchRules::By::distance,
                     .share = share_,
                     .least = least_,
                     .min_diameter = min_diameter_};
    for (const auto& [type, things] : paired_types(found, truth, type_)) {
      rules.scales.clear();
      if (const LandmarkType* known = all_types().find(type))
        for (const FeatureSpec& feature : known->features) rules.scales[feature.name] = feature.scale;
      scores[type] = score(things.first, things.second, rules, edges_);
    }
    std::cout << (format_ == "json" ? scores_as_json(scores) : scores_as_text(scores));
    return 0;
  }

 private:
  TrackEvaluation track_;
  std::string what_, result_, truth_, ignore_, type_, by_ = "distance", format_ = "text";
  double share_ = 0.75, least_ = 0, min_diameter_ = 0, min_pixels_ = 3;
  std::vector<double> edges_;
};

}  // namespace

void register_command_evaluate(CommandTable& commands);
void register_command_evaluate(CommandTable& commands) {
  commands.add<Evaluate>();
}

}  // namespace waymark
