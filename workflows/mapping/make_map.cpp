// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/make_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "geodb/write_map.hpp"
#include "importers/hash.hpp"
#include "importers/keep_hashes.hpp"
#include "importers/points/find_las.hpp"
#include "pipeline/craters/dem_blocks.hpp"
#include "workflows/file_access.hpp"
#include "workflows/mapping/assemble_map.hpp"
#include "workflows/mapping/call_costs.hpp"
#include "workflows/output_path.hpp"
#include "workflows/provenance.hpp"
#include "workflows/registries.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::workflows {
namespace {

void check_files(const CanopyFiles& canopy) {
  const auto& [chm, dsm, dtm, las, flights, crowns] = canopy;
  const bool surface = !dsm.empty() || !dtm.empty();
  if (chm.empty() && las.empty() && !surface)
    throw Error(ErrorCode::usage, "no canopy is given", "",
                "pass --chm CHM.tif, or --dsm DSM.tif --dtm DTM.tif, or --las POINTS.las");
  if (!las.empty() && !(dsm.empty() && chm.empty()))
    throw Error(
        ErrorCode::usage, "--las is given together with rasters of a canopy", "",
        "points make their own canopy model: leave out one or the other; --dtm may be given with points");
  if (!chm.empty() && surface)
    throw Error(ErrorCode::usage, "--chm is given together with --dsm or --dtm", "",
                "a canopy height model needs no terrain: leave out one or the other");
  if (las.empty() && surface && (dsm.empty() || dtm.empty()))
    throw Error(ErrorCode::usage,
                dsm.empty() ? "--dtm is given without --dsm or --las" : "--dsm is given without --dtm", "",
                "heights of trees are the surface less the terrain: give both");
}

void check_request(const pipeline::Job& job, const MapRequest& request) {
  const pipeline::RunOptions& asked = request.run;
  const bool partial = asked.shard || !asked.stage.empty() || !asked.unit.empty();
  if (partial && asked.work.empty())
    throw Error(ErrorCode::usage, "a part of a job needs --work DIR, which all parts use");
  if (request.map.empty() && !partial && !request.check)
    throw Error(ErrorCode::usage, "the map needs a name: -o MAP.gpkg", "",
                "--check looks at the job without making a map");
  if (request.map.empty()) return;
  for (const char* artifact : {"dem", "landmarks"})
    if (!job.pipeline.find_writer(artifact))
      throw Error(ErrorCode::usage,
                  std::string("no stage of the job writes '") + artifact + "', so there is no map", job.name,
                  "`waymark peaks DEM --print-job` shows a job that makes one");
  check_map_output(request.map);
  for (const auto& step : job.pipeline.steps())
    for (const std::string& file : step->input_files())
      keep_inputs(request.map, {pipeline::resolve_path(job.pipeline.base_folder, file)});
}

geodb::RunRecord run_record(const pipeline::Job& job, const pipeline::RunResult& result,
                            const std::string& command_line, std::chrono::system_clock::time_point started) {
  geodb::RunRecord run = make_run_record(command_line, started);
  run.job_json = pipeline::job_as_json(job.name, job.pipeline);
  record_report(run, result.report);
  run.inputs = result.inputs;
  return run;
}

void check_job(const pipeline::Job& job, const pipeline::RunOptions& options, const Callbacks& callbacks) {
  const pipeline::Plan units = pipeline::plan(job.pipeline, options);
  const auto done = std::ranges::count(units.units, true, &pipeline::Unit::done);
  callbacks.summary(fmt::format("the job is sound: {} stages, {} units of work, {} of them done\n",
                                job.pipeline.steps().size(), units.units.size(), done));
}

void send_report(const pipeline::RunReport& report, const Callbacks& callbacks) {
  callbacks.summary(pipeline::report_as_text(report));
  for (const pipeline::Failure& failure : report.failures)
    callbacks.send(MessageKind::failure, failure.unit + ": " + failure.message);
}

/// Requests a DEM in metres where the job loads images as well: images are placed on terrain in metres.
void require_metric_dem(pipeline::Pipeline& pipeline) {
  const auto has = [&](const char* name) {
    return std::ranges::any_of(pipeline.steps(), [&](const auto& step) { return step->spec().name == name; });
  };
  if (has("load_dem") && has("load_images")) pipeline.set("load_dem.metric=true");
}

nlohmann::json canopy_options(const CanopyFiles& canopy) {
  return {{"chm", canopy.chm},
          {"dsm", canopy.dsm},
          {"dtm", canopy.dtm},
          {"las", importers::find_las_files(canopy.las)},
          {"flights", canopy.flights}};
}

constexpr double kGroundSquareOfTowns = 60;                     // m: wider than most roofs
constexpr std::size_t kScratchInMemory = std::size_t{4} << 20;  // bytes of each stage's results

}  // namespace

void add_mountain_top_stages(pipeline::Pipeline& pipeline, const std::vector<std::string>& dem) {
  pipeline.add("load_dem", nlohmann::json{{"files", dem}}.dump());
  for (const char* stage :
       {"find_mountain_tops", "join_mountain_tops", "measure_isolation", "mountain_tops_of_tile"})
    pipeline.add(stage);
}

void add_name_stage(pipeline::Pipeline& pipeline, const std::vector<std::string>& gazetteers) {
  pipeline.add("load_names", nlohmann::json{{"files", gazetteers}}.dump());
}

void add_crater_stages(pipeline::Pipeline& pipeline, const std::vector<std::string>& dem) {
  pipeline.add(
      "load_dem",
      nlohmann::json{{"files", dem}, {"nodata", "unknown"}, {"tile_cells", pipeline::kDemCore}}.dump());
  for (const char* stage : {"craters_from_dem", "merge_observations", "value_surveys"}) pipeline.add(stage);
}

void add_tree_stages(pipeline::Pipeline& pipeline, const CanopyFiles& canopy) {
  check_files(canopy);
  pipeline.add("load_canopy", canopy_options(canopy).dump());
  pipeline.add("trees_from_canopy", nlohmann::json{{"crowns", canopy.crowns}}.dump());
  if (!canopy.flights) {
    pipeline.add("trees_of_survey");
    return;
  }
  pipeline.add("merge_observations", nlohmann::json{{"overlap", 0.1}}.dump());
  pipeline.add("value_flights");
}

void add_building_stages(pipeline::Pipeline& pipeline, const CanopyFiles& canopy, const TownParts& parts) {
  check_files(canopy);
  nlohmann::json load = canopy_options(canopy);
  load["ground_square"] = kGroundSquareOfTowns;
  pipeline.add("load_canopy", load.dump());
  pipeline.add("buildings_from_canopy");
  if (parts.poles) pipeline.add("poles_from_points");
  if (!parts.trees) return;
  pipeline.add("trees_from_canopy", nlohmann::json{{"roofs", "remove"}}.dump());
  pipeline.add("trees_of_survey");
}

pipeline::RunOptions run_options(const MapRequest& request, const Callbacks& callbacks) {
  pipeline::RunOptions options = request.run;
  options.progress = callbacks.progress;
  options.hash_file = importers::hash_file;
  if (!options.work.empty())
    options.hash_file = importers::keep_hashes(options.hash_file, options.work / "inputs");
  options.max_bytes_in_memory = kScratchInMemory;
  if (!options.types) options.types = &all_types();
  return options;
}

pipeline::Job load_job(const std::filesystem::path& file, const std::vector<std::string>& settings,
                       bool confined) {
  pipeline::Job job = pipeline::read_job(file, all_stages());
  if (confined) require_files_inside(job.pipeline, file);
  require_metric_dem(job.pipeline);
  for (const std::string& setting : settings) job.pipeline.set(setting);
  return job;
}

MapResult make_map(const pipeline::Job& job, const MapRequest& request, const Callbacks& callbacks) {
  pipeline::RunOptions options = run_options(request, callbacks);
  options.results = map_artifacts();
  options.scratch = std::filesystem::path(request.map).parent_path();
  if (options.scratch.empty()) options.scratch = ".";
  check_request(job, request);
  const std::shared_ptr<const SensorProfile> sensor =
      request.sensor.empty() ? nullptr : find_sensor(request.sensor);
  for (const std::string& warning : job.pipeline.warnings()) callbacks.warning(warning);
  MapResult made;
  if (request.check) {
    check_job(job, options, callbacks);
    return made;
  }
  const auto started = std::chrono::system_clock::now();
  pipeline::RunResult result = pipeline::run(job.pipeline, options);
  made.report = result.report;
  made.inputs = result.inputs;
  for (const InputFile& input : result.inputs)
    callbacks.send(MessageKind::detail, fmt::format("{}  {}", input.sha256, input.path));
  send_report(result.report, callbacks);
  keep_costs(options, result.report);
  if (request.map.empty()) return made;
  if (!has_all_landmarks(job.pipeline, result)) {
    callbacks.summary(request.map + " is not written: some units of work are missing\n");
    return made;
  }
  const auto done = std::chrono::steady_clock::now();
  geodb::RunRecord record = run_record(job, result, request.command_line, started);
  if (sensor) record_sensor(record.job_json, *sensor);
  const geodb::MapContents contents =
      assemble_map(result, *options.types, std::move(record), request.with_dem);
  made.landmarks = geodb::write_map(request.map, contents, {.empty_tables = detected_types(job.pipeline)});
  made.written = true;
  const std::chrono::duration<double> writing = std::chrono::steady_clock::now() - done;
  keep_cost_of_map(options, result.report, writing.count());
  callbacks.summary(summarize_run(result, contents, made.landmarks, request.map));
  return made;
}

}  // namespace waymark::workflows
