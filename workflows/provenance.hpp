// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <string>
#include "geodb/map_contents.hpp"
#include "pipeline/engine/report.hpp"
namespace waymark::workflows {

/// Returns "waymark 0.1.0".
std::string program_version();

/// Returns a record with version, command line and start (whole seconds, UTC), or SOURCE_DATE_EPOCH if it is
/// set.
geodb::RunRecord make_run_record(const std::string& command_line,
                                 std::chrono::system_clock::time_point started);

/// Stores a report and its duration in the record. If SOURCE_DATE_EPOCH is set, durations are 0 and reused
/// units count as made.
void record_report(geodb::RunRecord& run, pipeline::RunReport report);

/// Returns the record of a map that one step made of one file, without a job. The time runs from `started` to
/// now; the input is hashed.
geodb::RunRecord make_single_step_record(pipeline::StageReport stage, const std::string& input,
                                         const std::string& command_line,
                                         std::chrono::system_clock::time_point started);

}  // namespace waymark::workflows
