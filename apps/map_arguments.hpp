// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "apps/command.hpp"
#include "apps/session.hpp"
#include "workflows/mapping/make_map.hpp"
namespace waymark {

/// Returns the arguments that `waymark run` and the shortcuts share. They point into `request`.
std::vector<Argument> map_arguments(MapRequest& request);

/// Runs the job, writes the map and returns the exit code.
int make_map_command(const Job& job, MapRequest request, const Session& session);

}  // namespace waymark
