// SPDX-License-Identifier: Apache-2.0
#include "apps/help.hpp"

#include <iostream>

#include "apps/command.hpp"
#include "apps/command_json.hpp"
#include "apps/session.hpp"

namespace waymark::apps {
namespace {

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
