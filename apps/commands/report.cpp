// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/command.hpp"
#include "apps/log.hpp"
#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "exporters/report/report_html.hpp"
#include "workflows/evaluation/evaluate.hpp"
#include "workflows/query/map_of_area.hpp"

namespace waymark::apps {
namespace {

std::string checks_as_json(const std::vector<exporters::QualityCheck>& checks) {
  auto list = nlohmann::ordered_json::array();
  for (const exporters::QualityCheck& check : checks)
    list.push_back(
        {{"type", check.type}, {"claim", check.claim}, {"calibration_error", check.expected_error}});
  return list.dump();
}

class Report final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "report",
        .group = Group::use,
        .summary = "Write a report of a map as one HTML file",
        .about =
            "The page shows the landmarks on shaded relief, the most important of each type, histograms, the "
            "size-frequency distribution of craters, landmark quality, images with their detections, and the "
            "inputs and stages of the run. The page needs no network and no other file. Relief and images "
            "come "
            "from the map, or from the run's input files if they still exist. In a browser that runs "
            "scripts, the map zooms, landmarks are filtered and tables sorted.",
        .arguments =
            {file_word("MAP.gpkg", &map_, "Map to read"),
             Argument{"-o,--output", "REPORT.html", &html_, "Report to write; an older one is replaced"}
                 .needed()
                 .offering(Offer::file),
             Argument{"--aoi", "POLYGONS", &aoi_,
                      "Area of interest, in any CRS of the body: report the landmarks inside"}
                 .offering(Offer::file),
             Argument{"--min-confidence", "P", &min_confidence_,
                      "Report only landmarks that exist with at least this probability, 0 to 1"}
                 .or_else("0"),
             Argument{"--title", "TEXT", &options_.title, "Title of the page"}.or_else("the file's name"),
             Argument{"--static", "", &static_, "Write the page without a script"},
             Argument{"--top", "N", &options_.top, "Landmarks listed per type"}.or_else("25"),
             Argument{"--images", "N", &options_.images, "Images shown with what was found in them"}.or_else(
                 "4"),
             Argument{"--truth", "FILE", &truth_,
                      "Map or table of true objects: shows how reliable confidence and quality "
                      "are (see `waymark evaluate`)"}
                 .offering(Offer::file),
             format_option(&format_)},
        .examples = {{"waymark report alps.gpkg -o alps.html", "A report to read and to print"},
                     {"waymark report mars.gpkg -o mars.html --truth mars/truth.csv",
                      "With the truth of a testbed"}},
        .result = result_keys()};
  }

  int run(const Session&) override {
    options_.interactive = !static_;
    keep_inputs(html_, {map_, truth_, aoi_});
    if (!(min_confidence_ >= 0 && min_confidence_ <= 1))
      throw Error(ErrorCode::usage, fmt::format("--min-confidence is {:g}", min_confidence_), "",
                  "it is a probability: 0 to 1");
    const workflows::MapOfArea map(map_, aoi_, html_, min_confidence_);
    for (const std::string& warning : map.warnings()) log_warning(warning);
    if (!truth_.empty()) options_.checks = workflows::check_quality(map.path(), truth_);
    exporters::write_report(map.path(), html_, options_);
    log_summary(html_ + "\n");
    if (format_ == "json")
      print_result(result_keys(), {{"report", html_},
                                   {"bytes", static_cast<std::int64_t>(std::filesystem::file_size(html_))},
                                   {"checks", ResultJson{checks_as_json(options_.checks)}}});
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"report", ResultKind::text, "Report that was written"},
            {"bytes", ResultKind::integer, "Its size"},
            {"checks", ResultKind::objects,
             "With --truth: type, claim (confidence or quality), calibration_error (mean difference of the "
             "claimed probability and the correct fraction, 0 to 1)"}};
  }

  std::string format_ = "text";
  std::string map_, html_, truth_, aoi_;
  double min_confidence_ = 0;
  bool static_ = false;
  exporters::ReportOptions options_;
};

}  // namespace

void register_command_report(CommandTable& commands);
void register_command_report(CommandTable& commands) {
  commands.add<Report>();
}

}  // namespace waymark::apps
