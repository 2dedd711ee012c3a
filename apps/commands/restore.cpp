// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/command.hpp"
#include "apps/console.hpp"
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
            .arguments = {file_word("MAP.gpkg", &map_, "Map to restore"), format_option(&format_)},
            .examples = {{"waymark restore site.gpkg", "Undo the changes of the last drive or edit"}},
            .result = result_keys()};
  }

  int run(const Session& session) override {
    const auto backup = geodb::restore_map(map_);
    console_callbacks(session, format_).summary(fmt::format("{}: as it was in {}\n", map_, backup.string()));
    if (format_ == "json") print_result(result_keys(), {{"map", map_}, {"backup", backup.string()}});
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"map", ResultKind::text, "Map that was restored"},
            {"backup", ResultKind::text, "File of the earlier state, which is used up"}};
  }

  std::string format_ = "text";
  std::string map_;
};

}  // namespace

void register_command_restore(CommandTable& commands);
void register_command_restore(CommandTable& commands) {
  commands.add<Restore>();
}

}  // namespace waymark::apps
