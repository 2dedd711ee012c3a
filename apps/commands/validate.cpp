// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/command.hpp"
#include "apps/log.hpp"
#include "geodb/validate_map.hpp"

namespace waymark::apps {
namespace {

std::string findings_as_text(const std::vector<geodb::Finding>& findings) {
  std::string text;
  for (const geodb::Finding& finding : findings)
    text += fmt::format("{}\t{}\t{}\t{}\n", finding.code, finding.table,
                        finding.row ? std::to_string(*finding.row) : "", finding.text);
  return text;
}

std::string findings_as_json(const std::vector<geodb::Finding>& findings) {
  auto faults = nlohmann::ordered_json::array();
  for (const geodb::Finding& finding : findings)
    faults.push_back({{"code", finding.code},
                      {"table", finding.table},
                      {"row", finding.row ? nlohmann::ordered_json(*finding.row) : nullptr},
                      {"text", finding.text}});
  return faults.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

class Validate final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "validate",
            .group = Group::use,
            .summary = "Check a map for errors",
            .about =
                "Compares the RTree with the geometries, and checks evidence links, quality ranges and what "
                "else a GeoPackage validator does not know. Each fault is a line of tab-separated text: "
                "code, table, row, "
                "what is wrong. JSON is an array of the same. The exit code is 1 where there are faults.",
            .arguments = {file_word("MAP.gpkg", &map_, "Map to check; it is not changed"),
                          format_option(&format_)},
            .examples = {{"waymark validate alps.gpkg", "No output on standard output: the map is valid"},
                         {"waymark validate alps.gpkg --format json", "For a script: [] if it is valid"}}};
  }

  int run(const Session&) override {
    const std::vector<geodb::Finding> findings = geodb::validate_map(map_);
    std::cout << (format_ == "json" ? findings_as_json(findings) : findings_as_text(findings));
    log_summary(findings.empty() ? map_ + ": sound\n"
                                 : fmt::format("{}: {} faults\n", map_, findings.size()));
    return findings.empty() ? 0 : 1;
  }

 private:
  std::string map_, format_ = "text";
};

}  // namespace

void register_command_validate(CommandTable& commands);
void register_command_validate(CommandTable& commands) {
  commands.add<Validate>();
}

}  // namespace waymark::apps
