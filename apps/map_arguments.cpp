// SPDX-License-Identifier: Apache-2.0
#include "apps/map_arguments.hpp"

#include "apps/console.hpp"
#include "pipeline/engine/registry.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {

std::vector<Argument> map_arguments(workflows::MapRequest& request) {
  return {
      Argument{"-o,--output", "MAP.gpkg", &request.map,
               "Map to write. An older map of that name is replaced when the new one is complete; any other "
               "file is kept"}
          .offering(Offer::file),
      Argument{"--work", "DIR", &request.work,
               "Keep finished work here, so that a killed or changed run does only what is missing"}
          .offering(Offer::folder),
      Argument{"--rerun-from", "STAGE", &request.rerun_from,
               "Re-run this stage and its dependents, even if --work has their results"}
          .offering(workflows::all_stages().names()),
      {"--with-dem", "", &request.with_dem, "Store the DEM in the map as a gridded coverage"},
      Argument{"--sensor", "NAME|FILE", &request.sensor,
               "Record this sensor profile with the run: `--sensor map` of other commands uses it"}
          .offering(workflows::all_sensors().names()),
      {"--check", "", &request.check, "Check options, wiring and files, then stop"},
  };
}

int make_map_command(const pipeline::Job& job, workflows::MapRequest request, const Session& session) {
  request.threads = static_cast<int>(session.threads);
  request.command_line = session.command_line;
  return workflows::make_map(job, request, console_callbacks(session)).exit_code();
}

}  // namespace waymark::apps
