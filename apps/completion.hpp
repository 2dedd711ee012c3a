// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include "apps/command.hpp"
namespace waymark::apps {

/// Returns a bash script that completes commands, options, choices and paths without calling the program.
std::string bash_completion(std::span<const CommandSpec> commands, std::span<const Argument> globals);

}  // namespace waymark::apps
