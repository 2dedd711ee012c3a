// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <string>
#include "geodb/map_contents.hpp"
#include "pipeline/engine/report.hpp"
namespace waymark {

struct Session;

/// What every run of this program says of itself: version, command line, when it began (whole seconds, UTC).
RunRecord record_of_run(const std::string& command_line, std::chrono::system_clock::time_point started);

/// Of a map that one step made of one file, without a job: its time is from `started` to now, and its input
/// is hashed.
RunRecord record_of_one(StageReport stage, const std::string& input, const Session& session,
                        std::chrono::system_clock::time_point started);

}  // namespace waymark
