// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "apps/command.hpp"
#include "apps/session.hpp"
#include "workflows/mapping/make_map.hpp"
namespace waymark::apps {

/// Returns the arguments that `waymark run` and the shortcuts share. They point into `request`.
std::vector<Argument> map_arguments(workflows::MapRequest& request);

/// Runs the job, writes the map and returns the exit code.
int make_map_command(const pipeline::Job& job, workflows::MapRequest request, const Session& session);

}  // namespace waymark::apps
