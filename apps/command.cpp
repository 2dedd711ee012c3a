// SPDX-License-Identifier: Apache-2.0
#include "apps/command.hpp"

#include "core/error.hpp"

namespace waymark {

Command& CommandTable::find(std::string_view name) const {
  std::vector<std::string> names;
  for (const auto& command : commands_) {
    names.push_back(command->describe().name);
    if (names.back() == name) return *command;
  }
  const std::string nearest = nearest_name(name, names);
  throw Error(ErrorCode::usage, "waymark has no command '" + std::string(name) + "'", "",
              nearest.empty() ? "`waymark --help` lists them" : "did you mean '" + nearest + "'?");
}

std::vector<CommandSpec> CommandTable::describe() const {
  std::vector<CommandSpec> all;
  for (const auto& command : commands_) all.push_back(command->describe());
  return all;
}

}  // namespace waymark
