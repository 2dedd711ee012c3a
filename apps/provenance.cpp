// SPDX-License-Identifier: Apache-2.0
#include "apps/provenance.hpp"

#include <fmt/chrono.h>

#include "apps/session.hpp"
#include "importers/hash.hpp"

namespace waymark {

using Clock = std::chrono::system_clock;

RunRecord record_of_run(const std::string& command_line, Clock::time_point started) {
  RunRecord run;
  run.version = program_version();
  run.command_line = command_line;
  run.started_utc = fmt::format(
      "{:%FT%TZ}", fmt::gmtime(Clock::to_time_t(std::chrono::floor<std::chrono::seconds>(started))));
  return run;
}

RunRecord record_of_one(StageReport stage, const std::string& input, const Session& session,
                        Clock::time_point started) {
  RunRecord run = record_of_run(session.command_line, started);
  run.inputs = {hash_file(input)};
  run.seconds = stage.seconds = std::chrono::duration<double>(Clock::now() - started).count();
  RunReport report;
  report.seconds = stage.seconds;
  report.stages.push_back(std::move(stage));
  run.report_json = report_as_json(report);
  return run;
}

}  // namespace waymark
