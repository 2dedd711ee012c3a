// SPDX-License-Identifier: Apache-2.0
#include "apps/command_json.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "workflows/provenance.hpp"

namespace waymark::apps {
namespace {

using CommandJson = nlohmann::ordered_json;

/// Kinds of values, in the order of Target.
constexpr std::array kKinds{"flag", "integer", "number", "text", "numbers", "texts"};
static_assert(std::variant_size_v<Target> == kKinds.size());

CommandJson names_json(const std::string& names) {
  CommandJson list = CommandJson::array();
  for (std::size_t first = 0; first < names.size();) {
    const std::size_t end = std::min(names.find(',', first), names.size());
    list.push_back(names.substr(first, end - first));
    first = end + 1;
  }
  return list;
}

CommandJson argument_json(const Argument& argument) {
  CommandJson json{{"names", names_json(argument.names)},
                   {"value", argument.value},
                   {"kind", kKinds[argument.into.index()]},
                   {"help", argument.help},
                   {"required", argument.required}};
  if (!argument.choices.empty()) json["choices"] = argument.choices;
  if (!argument.suggestions.empty()) json["suggestions"] = argument.suggestions;
  if (argument.offer != Offer::nothing) json["offer"] = argument.offer == Offer::file ? "file" : "folder";
  if (!argument.otherwise.empty()) json["default"] = argument.otherwise;
  return json;
}

CommandJson arguments_json(std::span<const Argument> arguments) {
  CommandJson list = CommandJson::array();
  for (const Argument& argument : arguments) list.push_back(argument_json(argument));
  return list;
}

const char* group_name(Group group) {
  return group == Group::make ? "make" : group == Group::use ? "use" : "look_up";
}

}  // namespace

std::string commands_as_json(std::span<const CommandSpec> commands, std::span<const Argument> globals) {
  CommandJson list = CommandJson::array();
  for (const CommandSpec& command : commands) {
    CommandJson examples = CommandJson::array();
    for (const Example& example : command.examples)
      examples.push_back({{"command", example.command_line}, {"summary", example.says}});
    list.push_back({{"name", command.name},
                    {"group", group_name(command.group)},
                    {"summary", command.summary},
                    {"about", command.about},
                    {"arguments", arguments_json(command.arguments)},
                    {"examples", examples}});
  }
  return CommandJson{{"version", workflows::program_version()},
                     {"globals", arguments_json(globals)},
                     {"commands", list}}
             .dump(1) +
         "\n";
}

}  // namespace waymark::apps
