// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include "apps/command.hpp"
namespace waymark::apps {

/// Returns a zsh function that completes commands, options, choices and paths without calling the program. It
/// may be sourced, or lie in a folder of fpath as `_waymark`.
std::string zsh_completion(std::span<const CommandSpec> commands, std::span<const Argument> globals);

/// Returns the same for fish.
std::string fish_completion(std::span<const CommandSpec> commands, std::span<const Argument> globals);

}  // namespace waymark::apps
