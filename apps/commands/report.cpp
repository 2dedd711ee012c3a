// SPDX-License-Identifier: Apache-2.0
#include "apps/command.hpp"
#include "apps/log.hpp"
#include "apps/scored_table.hpp"
#include "core/error.hpp"
#include "exporters/report_html.hpp"

namespace waymark {
namespace {

class Report final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "report",
        .group = Group::use,
        .summary = "Write a report of a map as one HTML file",
        .about =
            "Shaded relief with the landmarks, the foremost of each type, histograms, the size-frequency "
            "distribution of craters, how good the landmarks are, images with what was found in them, "
            "what the run read and did. It needs no network and no other file. Relief and images come from "
            "the map, or from the run's input files where they are still there.",
        .arguments =
            {file_word("MAP.gpkg", &map_, "Map to read"),
             Argument{"-o,--output", "REPORT.html", &html_, "Report to write; an older one is replaced"}
                 .needed()
                 .offering(Offer::file),
             Argument{"--title", "TEXT", &options_.title, "Title of the page"}.or_else("the file's name"),
             Argument{"--top", "N", &options_.top, "Landmarks listed per type"}.or_else("25"),
             Argument{"--images", "N", &options_.images, "Images shown with what was found in them"}.or_else(
                 "4"),
             Argument{"--truth", "FILE", &truth_,
                      "Map or table of what is there: shows how far confidence and quality are "
                      "right (see `waymark evaluate`)"}
                 .offering(Offer::file)},
        .examples = {
            {"waymark report alps.gpkg -o alps.html", "A report to read and to print"},
            {"waymark report mars.gpkg -o mars.html --truth mars/truth.csv", "With the truth of a testbed"}}};
  }

  int run(const Session&) override {
    if (!truth_.empty()) compare_with_truth();
    write_report(map_, html_, options_);
    say(html_ + "\n");
    return 0;
  }

 private:
  void compare_with_truth() {
    constexpr double least_pixels = 3;  // as evaluate has it
    const auto pairs = paired_types(scored_things(map_, "", 0), scored_things(truth_, "", least_pixels), "");
    for (const auto& [type, things] : pairs) {
      const Score result = score(things.first, things.second, {});
      for (const auto& [claim, bins, error] :
           {std::tuple{"confidence", result.by_confidence, result.confidence_error},
            {"quality", result.by_quality, result.quality_error}}) {
        QualityCheck check{.type = type, .claim = claim, .bins = {}, .expected_error = error};
        for (const CalibrationBin& bin : bins) check.bins.push_back({bin.mean, bin.found, bin.right});
        options_.checks.push_back(std::move(check));
      }
    }
  }

  std::string map_, html_, truth_;
  ReportOptions options_;
};

}  // namespace

void register_command_report(CommandTable& commands);
void register_command_report(CommandTable& commands) {
  commands.add<Report>();
}

}  // namespace waymark
