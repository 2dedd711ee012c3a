// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "apps/command.hpp"
#include "apps/session.hpp"
#include "workflows/mapping/make_map.hpp"
namespace waymark::apps {

/// What `waymark run` and the shortcuts were asked for.
struct MapCommand {
  workflows::MapRequest request = {};
  std::string work = {};        ///< work folder of the run
  std::string format = "text";  ///< of standard output: "json" prints what was done
};

/// Returns the arguments that `waymark run` and the shortcuts share. They point into `asked`.
std::vector<Argument> map_arguments(MapCommand& asked);

/// Returns the arguments that name the files of a canopy. They point into `files`.
std::vector<Argument> canopy_arguments(workflows::CanopyFiles& files);

/// Returns the keys of what `waymark run` and the shortcuts print with `--format json`.
std::vector<ResultKey> map_result_keys();

/// Runs the job, writes the map and returns the exit code.
int make_map_command(const pipeline::Job& job, const MapCommand& asked, const Session& session);

}  // namespace waymark::apps
