// SPDX-License-Identifier: Apache-2.0
#include "apps/command.hpp"
#include "apps/log.hpp"
#include "exporters/report_html.hpp"

namespace waymark {
namespace {

class Report final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "report",
            .group = Group::use,
            .summary = "Write a report of a map as one HTML file",
            .about =
                "Shaded relief with the landmarks, the foremost of each type, histograms, what the run "
                "read and did. It needs no network and no other file. The relief comes from the DEM in the "
                "map, or from the run's input files where they are still there.",
            .arguments = {file_word("MAP.gpkg", &map_, "Map to read"),
                          Argument{"-o,--output", "REPORT.html", &html_,
                                   "Report to write; an older one is replaced"}
                              .needed()
                              .offering(Offer::file),
                          Argument{"--title", "TEXT", &options_.title, "Title of the page"}.or_else(
                              "the file's name"),
                          Argument{"--top", "N", &options_.top, "Landmarks listed per type"}.or_else("25")},
            .examples = {{"waymark report alps.gpkg -o alps.html", "A report to read and to print"}}};
  }

  int run(const Session&) override {
    write_report(map_, html_, options_);
    say(html_ + "\n");
    return 0;
  }

 private:
  std::string map_, html_;
  ReportOptions options_;
};

}  // namespace

void register_command_report(CommandTable& commands);
void register_command_report(CommandTable& commands) {
  commands.add<Report>();
}

}  // namespace waymark
