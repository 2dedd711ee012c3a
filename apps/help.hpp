// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include "apps/command.hpp"
namespace waymark::apps {

/// Returns the text of `waymark --help`: commands by group, and global options.
std::string program_help(std::span<const CommandSpec> commands, std::span<const Argument> globals);

/// Returns the text of `waymark NAME --help`.
std::string command_help(const CommandSpec& command, std::span<const Argument> globals);

/// Returns the help of an argument with its choices.
std::string full_help(const Argument& argument);

struct ExitCode {
  int code = 0;
  std::string says;
};
std::vector<ExitCode> exit_codes();

}  // namespace waymark::apps
