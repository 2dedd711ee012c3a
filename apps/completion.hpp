// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include "apps/command.hpp"
namespace waymark {

/// A script for bash that completes commands, options, choices and paths. It never calls the program.
std::string bash_completion(std::span<const CommandSpec> commands, std::span<const Argument> globals);

}  // namespace waymark
