// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/command.hpp"
#include "apps/log.hpp"
#include "geodb/update_map.hpp"

namespace waymark::apps {
namespace {

class Restore final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "restore",
            .group = Group::make,
            .summary = "Undo the last update of a map",
            .about =
                "Puts back the state a map had before `waymark edit` or `waymark localize --update-map` last "
                "changed it. "
                "That state lies beside the map as MAP.gpkg.before-run-N, N the number of the run; it "
                "is used up. Earlier updates can be undone in turn.",
            .arguments = {file_word("MAP.gpkg", &map_, "Map to restore")},
            .examples = {{"waymark restore site.gpkg", "Undo the changes of the last drive or edit"}}};
  }

  int run(const Session&) override {
    const auto backup = geodb::restore_map(map_);
    log_summary(fmt::format("{}: as it was in {}\n", map_, backup.string()));
    return 0;
  }

 private:
  std::string map_;
};

}  // namespace

void register_command_restore(CommandTable& commands);
void register_command_restore(CommandTable& commands) {
  commands.add<Restore>();
}

}  // namespace waymark::apps
