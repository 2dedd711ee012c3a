// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "apps/command.hpp"
#include "pipeline/engine/job.hpp"
#include "pipeline/engine/runner.hpp"
namespace waymark {

/// How a job is run and what becomes of it: the arguments `waymark run` and the shortcuts share.
struct MapRequest {
  std::string map;         ///< output; empty: none, only the work folder grows
  std::string work;        ///< empty: everything in memory
  std::string rerun_from;  ///< a stage; empty: what is there is kept
  bool check = false;      ///< plan only
  bool with_dem = false;   ///< store the DEM in the map
};
std::vector<Argument> map_arguments(MapRequest& request);

/// Runs the job and writes the map: the one code path behind every command that makes one. Ends with a
/// summary on standard error. Returns the exit code. Where single images failed the map is made of the
/// others; where it cannot be made it is not written and an older one is kept. The output is refused before
/// any work is done.
int make_map(const Job& job, const MapRequest& request, RunOptions options, const Session& session);

/// Engine options that every command shares: threads, hashes of any GDAL path, progress.
RunOptions run_options(const Session& session);

}  // namespace waymark
