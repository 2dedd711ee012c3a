// SPDX-License-Identifier: Apache-2.0
#include "apps/help.hpp"

#include <iostream>

#include "apps/command.hpp"
#include "apps/session.hpp"

namespace waymark::apps {
namespace {

class Help final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "help",
            .group = Group::look_up,
            .summary = "Explain a command, or list all commands",
            .about = "`waymark help COMMAND` is `waymark COMMAND --help`.",
            .arguments = {Argument{"", "COMMAND", &command_, "Command to explain"}},
            .examples = {{"waymark help peaks", "Options and examples of `waymark peaks`"}}};
  }

  int run(const Session&) override {
    CommandTable commands;
    register_commands(commands);
    Session any;
    const std::vector<Argument> globals = global_arguments(any);
    std::cout << (command_.empty() ? program_help(commands.describe(), globals)
                                   : command_help(commands.find(command_).describe(), globals));
    return 0;
  }

 private:
  std::string command_;
};

}  // namespace

void register_command_help(CommandTable& commands);
void register_command_help(CommandTable& commands) {
  commands.add<Help>();
}

}  // namespace waymark::apps
