// SPDX-License-Identifier: Apache-2.0
#include "apps/map_arguments.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/console.hpp"
#include "core/json_text.hpp"
#include "pipeline/engine/registry.hpp"
#include "pipeline/engine/report.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

/// Returns the map, its landmarks by type, the input files and the report of the stages.
std::string result_as_json(const workflows::MapResult& result, const std::string& map) {
  nlohmann::ordered_json json;
  json["map"] = result.written ? nlohmann::ordered_json(map) : nullptr;
  json["landmarks"] = result.landmarks;
  json["inputs"] = nlohmann::ordered_json::array();
  for (const auto& input : result.inputs)
    json["inputs"].push_back({{"path", input.path}, {"sha256", input.sha256}});
  json["run"] =
      nlohmann::ordered_json::parse(checked_json(pipeline::report_as_json(result.report), "report"));
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::vector<Argument> map_arguments(MapCommand& asked) {
  workflows::MapRequest& request = asked.request;
  return {
      Argument{"-o,--output", "MAP.gpkg", &request.map,
               "Map to write. An older map of that name is replaced when the new one is complete; any other "
               "file is kept"}
          .offering(Offer::file),
      Argument{"--work", "DIR", &asked.work,
               "Keep finished work here, so that a killed or changed run does only what is missing"}
          .offering(Offer::folder),
      Argument{"--rerun-from", "STAGE", &request.run.rerun_from,
               "Re-run this stage and its dependents, even if --work has their results"}
          .offering(workflows::all_stages().names()),
      {"--with-dem", "", &request.with_dem, "Store the DEM in the map as a gridded coverage"},
      Argument{"--sensor", "NAME|FILE", &request.sensor,
               "Record this sensor profile with the run: `--sensor map` of other commands uses it"}
          .offering(workflows::all_sensors().names()),
      {"--check", "", &request.check, "Check options, wiring and files, then stop"},
      format_option(&asked.format),
  };
}

int make_map_command(const pipeline::Job& job, const MapCommand& asked, const Session& session) {
  workflows::MapRequest request = asked.request;
  request.run.work = asked.work;
  request.run.threads = static_cast<int>(session.threads);
  request.command_line = session.command_line;
  const workflows::MapResult result = workflows::make_map(job, request, console_callbacks(session));
  if (asked.format == "json") std::cout << result_as_json(result, request.map);
  return result.exit_code();
}

}  // namespace waymark::apps
