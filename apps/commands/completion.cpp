// SPDX-License-Identifier: Apache-2.0
#include "apps/completion.hpp"

#include <iostream>

#include "apps/command.hpp"
#include "apps/session.hpp"

namespace waymark::apps {
namespace {

class Completion final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "completion",
            .group = Group::look_up,
            .summary = "Print a script that completes waymark's command lines in a shell",
            .about = "It completes commands, options, values and file names.",
            .arguments = {Argument{"", "SHELL", &shell_, "Shell to complete in"}.needed().one_of({"bash"})},
            .examples = {{"source <(waymark completion bash)", "Completion for this shell"},
                         {"waymark completion bash > ~/.local/share/bash-completion/completions/waymark",
                          "Completion for every shell to come"}}};
  }

  int run(const Session&) override {
    CommandTable commands;
    register_commands(commands);
    Session any;
    std::cout << bash_completion(commands.describe(), global_arguments(any));
    return 0;
  }

 private:
  std::string shell_;
};

}  // namespace

void register_command_completion(CommandTable& commands);
void register_command_completion(CommandTable& commands) {
  commands.add<Completion>();
}

}  // namespace waymark::apps
