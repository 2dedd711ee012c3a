// SPDX-License-Identifier: Apache-2.0
#include "apps/map_arguments.hpp"

#include <nlohmann/json.hpp>

#include "apps/console.hpp"
#include "pipeline/engine/registry.hpp"
#include "pipeline/engine/report.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

std::string inputs_as_json(const std::vector<InputFile>& inputs) {
  auto list = nlohmann::ordered_json::array();
  for (const InputFile& input : inputs) list.push_back({{"path", input.path}, {"sha256", input.sha256}});
  return list.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void print_map_result(const workflows::MapResult& result, const std::string& map) {
  print_result(map_result_keys(), {{"map", text_or_null(result.written ? map : "")},
                                   {"landmarks", result.landmarks},
                                   {"inputs", ResultJson{inputs_as_json(result.inputs)}},
                                   {"run", ResultJson{pipeline::report_as_json(result.report)}}});
}

}  // namespace

std::vector<Argument> canopy_arguments(workflows::CanopyFiles& files) {
  return {
      Argument{"--chm", "CHM...", &files.chm, "Canopy height models, heights above ground, that GDAL opens"}
          .offering(Offer::file),
      Argument{"--dsm", "DSM...", &files.dsm, "Surface models, with --dtm"}.offering(Offer::file),
      Argument{"--dtm", "DTM...", &files.dtm,
               "Terrain models on any grid, under the surface or the laser points"}
          .offering(Offer::file),
      Argument{"--las", "FILE...", &files.las,
               "LAS, LAZ or COPC files, or folders of them: one catalogue, with ground classified or "
               "--dtm"}
          .offering(Offer::file)};
}

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

std::vector<ResultKey> map_result_keys() {
  return {{"map", ResultKind::text, "Map that was written; null: none, as with --check"},
          {"landmarks", ResultKind::counts, "Landmarks by type"},
          {"inputs", ResultKind::objects, "Input files: path, sha256"},
          {"run", ResultKind::object, "Report of the stages, as in the table `run` of the map"}};
}

int make_map_command(const pipeline::Job& job, const MapCommand& asked, const Session& session) {
  workflows::MapRequest request = asked.request;
  request.run.work = asked.work;
  request.run.threads = static_cast<int>(session.threads);
  request.command_line = session.command_line;
  const workflows::MapResult result =
      workflows::make_map(job, request, console_callbacks(session, asked.format));
  if (asked.format == "json") print_map_result(result, request.map);
  return result.exit_code();
}

}  // namespace waymark::apps
