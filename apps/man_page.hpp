// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include "apps/command.hpp"
namespace waymark::apps {

/// Returns waymark(1) as roff, all commands on one page.
std::string man_page(std::span<const CommandSpec> commands, std::span<const Argument> globals);

}  // namespace waymark::apps
