// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <iostream>
#include <limits>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "workflows/mapping/edit_map.hpp"

namespace waymark::apps {
namespace {

using workflows::MapEdit;

struct EditName {
  const char* name;
  MapEdit edit;
};
constexpr std::array<EditName, 4> kEdits{{{"accept", MapEdit::accept},
                                          {"reject", MapEdit::reject},
                                          {"add", MapEdit::add},
                                          {"move", MapEdit::move}}};

class Edit final : public Command {
 public:
  CommandSpec describe() override {
    std::vector<std::string> names;
    for (const EditName& edit : kEdits) names.emplace_back(edit.name);
    return {
        .name = "edit",
        .group = Group::make,
        .summary = "Correct a map by hand: accept, reject, add or move landmarks",
        .about =
            "accept sets the confidence of landmarks that exist; reject removes those that do not, and "
            "keeps their evidence as rejected; add inserts a landmark that was missed; move corrects a "
            "position. Everything is checked, recorded as a run of the map, and written at once or not at "
            "all. Without -o the map itself is changed, and `waymark restore` takes it back. The uids of "
            "the landmarks are printed.",
        .arguments =
            {file_word("MAP.gpkg", &request_.map, "Map to correct"),
             Argument{"", "ACTION", &action_, "What is done"}.one_of(names).needed(),
             Argument{"", "UID...", &request_.uids, "Landmarks; `waymark query` prints their uids"},
             Argument{"-o,--output", "MAP.gpkg", &request_.result, "Write another map instead"}.offering(
                 Offer::file),
             {"--type", "TYPE", &request_.type, "Type of the new landmark"},
             {"--at", "X Y", &request_.at, "Position in the CRS of the map"},
             Argument{"--z", "M", &z_, "Height of that position, metres"}.or_else("as it was"),
             {"--rim", "X1 Y1 X2 Y2 X3 Y3", &request_.rim,
              "Three points of the outline: the circle through them gives position and "
              "size"},
             {"--feature", "FEATURE=VALUE", &request_.features,
              "Feature of the new landmark; may be repeated"},
             Argument{"--position-sd", "M", &request_.position_sd,
                      "Standard deviation of the position, metres"}
                 .or_else("not known"),
             Argument{"--confidence", "P", &request_.confidence, "Of accepted and new landmarks"}.or_else(
                 "0.99"),
             {"--reason", "TEXT", &request_.reason, "Recorded with the run"},
             format_option(&format_)},
        .examples = {{"waymark edit site.gpkg reject rock-8v2k1 rock-8v2q7 --reason 'tents'",
                      "Remove two false rocks"},
                     {"waymark edit site.gpkg add --type crater --rim 10 0 0 10 -10 0",
                      "A crater by three points"},
                     {"waymark edit site.gpkg add --type rock --at 12.5 40 --feature radius=0.4", "A rock"},
                     {"waymark edit site.gpkg move rock-8v2k1 --at 12.7 40.1 --position-sd 0.05",
                      "A surveyed position"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    for (const EditName& edit : kEdits)
      if (action_ == edit.name) request_.edit = edit.edit;
    if (!std::isnan(z_)) request_.z = z_;
    request_.command_line = session.command_line;
    const std::vector<std::string> uids = workflows::edit_map(request_, console_callbacks(session, format_));
    if (format_ == "json") {
      print_result(result_keys(), {{"map", request_.result.empty() ? request_.map : request_.result},
                                   {"action", action_},
                                   {"landmarks", uids}});
      return 0;
    }
    for (const std::string& uid : uids) std::cout << uid << '\n';
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"map", ResultKind::text, "Map that was changed or written"},
            {"action", ResultKind::text, "accept, reject, add or move"},
            {"landmarks", ResultKind::texts, "Uids of the landmarks concerned"}};
  }

  std::string format_ = "text";
  workflows::EditRequest request_;
  std::string action_;
  double z_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

void register_command_edit(CommandTable& commands);
void register_command_edit(CommandTable& commands) {
  commands.add<Edit>();
}

}  // namespace waymark::apps
