// SPDX-License-Identifier: Apache-2.0
#include "apps/make_map.hpp"

#include <fmt/format.h>

#include <chrono>

#include "apps/log.hpp"
#include "apps/map_of_run.hpp"
#include "apps/output_path.hpp"
#include "apps/progress.hpp"
#include "apps/provenance.hpp"
#include "apps/registries.hpp"
#include "apps/session.hpp"
#include "core/error.hpp"
#include "geodb/write_map.hpp"
#include "importers/hash.hpp"

namespace waymark {
namespace {

void check_request(const Job& job, const MapRequest& request, const RunOptions& options) {
  const bool share = options.shard || !options.unit.empty();
  if (share && request.work.empty())
    throw Error(ErrorCode::usage, "a share of a job needs --work DIR, where all shares meet");
  if (request.map.empty() && !share && !request.check)
    throw Error(ErrorCode::usage, "the map needs a name: -o MAP.gpkg", "",
                "--check looks at the job without making a map");
  if (request.map.empty()) return;
  for (const char* artifact : {"dem", "landmarks"})
    if (!job.pipeline.writer_of(artifact))
      throw Error(ErrorCode::usage,
                  std::string("no stage of the job writes '") + artifact + "', so there is no map", job.name,
                  "`waymark peaks DEM --print-job` shows a job that makes one");
  check_map_output(request.map);
}

RunRecord record_of(const Job& job, const RunResult& result, const Session& session,
                    std::chrono::system_clock::time_point started) {
  RunRecord run = record_of_run(session.command_line, started);
  run.job_json = job_as_json(job.name, job.pipeline);
  run.report_json = report_as_json(result.report);
  run.seconds = result.report.seconds;
  run.inputs = result.inputs;
  return run;
}

/// Failures are told even by a quiet program.
void tell(const RunReport& report) {
  say(report_as_text(report));
  if (!quiet_log()) return;
  for (const Failure& failure : report.failures) log_error(failure.unit + ": " + failure.message);
}

int check(const Job& job, const RunOptions& options) {
  std::int64_t done = 0;
  const Plan units = plan(job.pipeline, options);
  for (const Unit& unit : units.units) done += unit.done ? 1 : 0;
  say(fmt::format("the job is sound: {} stages, {} units of work, {} of them done\n",
                  job.pipeline.steps().size(), units.units.size(), done));
  return 0;
}

}  // namespace

std::vector<Argument> map_arguments(MapRequest& request) {
  return {
      Argument{"-o,--output", "MAP.gpkg", &request.map,
               "Map to write; an older map of that name is replaced when the new one is whole, any other "
               "file is kept"}
          .offering(Offer::file),
      Argument{"--work", "DIR", &request.work,
               "Keep finished work here, so that a killed or changed run does only what is missing"}
          .offering(Offer::folder),
      Argument{"--rerun-from", "STAGE", &request.rerun_from,
               "Make this stage and all that depends on it anew, whatever is in --work"}
          .offering(all_stages().names()),
      {"--with-dem", "", &request.with_dem, "Store the DEM in the map as a gridded coverage"},
      {"--check", "", &request.check, "Check options, wiring and files, then stop"},
  };
}

RunOptions run_options(const Session& session) {
  RunOptions options;
  options.threads = static_cast<int>(session.threads);
  options.progress = progress_renderer(session);
  options.hash_file = hash_file;
  return options;
}

int make_map(const Job& job, const MapRequest& request, RunOptions options, const Session& session) {
  options.work = request.work;
  options.rerun_from = request.rerun_from;
  options.results = artifacts_of_a_map();
  options.scratch = std::filesystem::path(request.map).parent_path();
  if (options.scratch.empty()) options.scratch = ".";
  check_request(job, request, options);
  if (request.check) return check(job, options);
  const auto started = std::chrono::system_clock::now();
  RunResult result = run(job.pipeline, options);
  for (const InputFile& input : result.inputs) log_detail(fmt::format("{}  {}", input.sha256, input.path));
  tell(result.report);
  if (request.map.empty()) return result.report.exit_code();
  if (!makes_map(job.pipeline, result)) {
    say(request.map + " is not written: some units of work are missing\n");
    return result.report.exit_code();
  }
  const MapContents contents = map_of_run(result, record_of(job, result, session, started), request.with_dem);
  const auto written = write_map(request.map, contents, {.empty_tables = types_found(job.pipeline)});
  say(summary_of_run(result, contents, written, request.map));
  return result.report.exit_code();
}

}  // namespace waymark
