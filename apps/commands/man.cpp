// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "apps/command.hpp"
#include "apps/man_page.hpp"
#include "apps/session.hpp"

namespace waymark::apps {
namespace {

class Man final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "man",
            .group = Group::look_up,
            .summary = "Print the manual page",
            .examples = {{"waymark man | man -l -", "Read it"},
                         {"waymark man > ~/.local/share/man/man1/waymark.1", "Keep it where man finds it"}}};
  }

  int run(const Session&) override {
    CommandTable commands;
    register_commands(commands);
    Session any;
    std::cout << man_page(commands.describe(), global_arguments(any));
    return 0;
  }
};

}  // namespace

void register_command_man(CommandTable& commands);
void register_command_man(CommandTable& commands) {
  commands.add<Man>();
}

}  // namespace waymark::apps
