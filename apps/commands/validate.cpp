// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>

#include "apps/command.hpp"
#include "apps/log.hpp"
#include "geodb/validate_map.hpp"

namespace waymark::apps {
namespace {

class Validate final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "validate",
            .group = Group::use,
            .summary = "Check a map for errors",
            .about =
                "RTree against geometry, evidence links, quality ranges and all else a GeoPackage "
                "validator does not know. Each fault is a line of tab-separated text: code, table, row, "
                "what is wrong. The exit code is 1 where there are faults.",
            .arguments = {file_word("MAP.gpkg", &map_, "Map to check; it is not changed")},
            .examples = {{"waymark validate alps.gpkg", "Nothing on standard output: the map is sound"}}};
  }

  int run(const Session&) override {
    const std::vector<geodb::Finding> findings = geodb::validate_map(map_);
    for (const geodb::Finding& finding : findings)
      std::cout << fmt::format("{}\t{}\t{}\t{}\n", finding.code, finding.table,
                               finding.row ? std::to_string(*finding.row) : "", finding.text);
    log_summary(findings.empty() ? map_ + ": sound\n"
                                 : fmt::format("{}: {} faults\n", map_, findings.size()));
    return findings.empty() ? 0 : 1;
  }

 private:
  std::string map_;
};

}  // namespace

void register_command_validate(CommandTable& commands);
void register_command_validate(CommandTable& commands) {
  commands.add<Validate>();
}

}  // namespace waymark::apps
