// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include "apps/command.hpp"
namespace waymark::apps {

/// Returns the declarations of commands and global options as JSON, from which other programs make forms:
/// {"version": ..., "globals": [...], "commands": [{"name", "group", "summary", "about", "arguments",
/// "examples"}]}. An argument has "names" (none: a positional word), "value", "kind" (flag, integer, number,
/// numbers, text, texts), "help", "required", and if there are any "choices", "suggestions", "offer" (file,
/// folder), "default".
std::string commands_as_json(std::span<const CommandSpec> commands, std::span<const Argument> globals);

}  // namespace waymark::apps
