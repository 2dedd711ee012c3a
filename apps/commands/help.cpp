// SPDX-License-Identifier: Apache-2.0
#include "apps/help.hpp"

#include <array>
#include <iostream>
#include <nlohmann/json.hpp>
#include <span>

#include "apps/command.hpp"
#include "apps/session.hpp"
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

CommandJson result_json(std::span<const ResultKey> keys) {
  CommandJson list = CommandJson::array();
  for (const ResultKey& key : keys)
    list.push_back({{"name", key.name}, {"kind", name_of(key.kind)}, {"meaning", key.meaning}});
  return list;
}

const char* group_name(Group group) {
  return group == Group::make ? "make" : group == Group::use ? "use" : "look_up";
}

/// Returns the declarations of commands and global options as JSON, from which other programs make forms:
/// {"version": ..., "globals": [...], "commands": [{"name", "group", "summary", "about", "arguments",
/// "examples", "result"}]}. "result" lists the keys of what the command prints with `--format json`, `export`
/// with `--summary json`: "name", "kind" (of ResultKind), "meaning". An argument has "names" (none: a
/// positional word), "value", "kind" (flag, integer, number, numbers, text, texts), "help", "required", and
/// if there are any "choices", "suggestions", "offer" (file, folder), "default".
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
                    {"examples", examples},
                    {"result", result_json(command.result)}});
  }
  return CommandJson{{"version", workflows::program_version()},
                     {"globals", arguments_json(globals)},
                     {"commands", list}}
             .dump(1) +
         "\n";
}

class Help final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "help",
        .group = Group::look_up,
        .summary = "Explain a command, or list all commands",
        .about =
            "`waymark help COMMAND` is `waymark COMMAND --help`. As JSON, the declarations are for programs "
            "that make forms of them.",
        .arguments = {Argument{"", "COMMAND", &command_, "Command to explain"}, format_option(&format_)},
        .examples = {{"waymark help peaks", "Options and examples of `waymark peaks`"},
                     {"waymark help --format json", "All commands and options, for a program"}}};
  }

  int run(const Session&) override {
    CommandTable commands;
    register_commands(commands);
    Session any;
    const std::vector<Argument> globals = global_arguments(any);
    if (format_ == "json") {
      std::vector<CommandSpec> asked = commands.describe();
      if (!command_.empty()) asked = {commands.find(command_).describe()};
      std::cout << commands_as_json(asked, globals);
      return 0;
    }
    std::cout << (command_.empty() ? program_help(commands.describe(), globals)
                                   : command_help(commands.find(command_).describe(), globals));
    return 0;
  }

 private:
  std::string command_, format_;
};

}  // namespace

void register_command_help(CommandTable& commands);
void register_command_help(CommandTable& commands) {
  commands.add<Help>();
}

}  // namespace waymark::apps
