// SPDX-License-Identifier: Apache-2.0
#include "workflows/provenance.hpp"

#include <fmt/chrono.h>

#include <utility>

#include "core/source_date.hpp"
#include "importers/hash.hpp"

namespace waymark::workflows {

using Clock = std::chrono::system_clock;

std::string program_version() {
  return "waymark " WAYMARK_VERSION;
}

geodb::RunRecord make_run_record(const std::string& command_line, Clock::time_point started) {
  geodb::RunRecord run;
  if (const auto fixed = source_date()) started = *fixed;
  run.version = program_version();
  run.command_line = command_line;
  run.started_utc = fmt::format(
      "{:%FT%TZ}", fmt::gmtime(Clock::to_time_t(std::chrono::floor<std::chrono::seconds>(started))));
  return run;
}

geodb::RunRecord make_single_step_record(pipeline::StageReport stage, const std::string& input,
                                         const std::string& command_line, Clock::time_point started) {
  geodb::RunRecord run = make_run_record(command_line, started);
  run.inputs = {importers::hash_file(input)};
  pipeline::RunReport report;
  report.seconds = stage.seconds = std::chrono::duration<double>(Clock::now() - started).count();
  report.stages.push_back(std::move(stage));
  record_report(run, std::move(report));
  return run;
}

void record_report(geodb::RunRecord& run, pipeline::RunReport report) {
  if (source_date()) {
    report.seconds = 0;
    for (pipeline::StageReport& stage : report.stages) {
      stage.seconds = 0;
      stage.made += std::exchange(stage.reused, 0);  // a resumed run gives the same bytes
    }
  }
  run.seconds = report.seconds;
  run.report_json = pipeline::report_as_json(report);
}

}  // namespace waymark::workflows
