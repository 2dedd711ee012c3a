// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>
#include "core/error.hpp"
#include "pipeline/engine/stage_context.hpp"
namespace waymark::pipeline {

/// Outcome of one stage: units = made + reused + failed + skipped + waiting.
struct StageReport {
  std::string stage;
  std::int64_t units = 0;
  std::int64_t made = 0;    ///< in this run
  std::int64_t reused = 0;  ///< found in the work folder
  std::int64_t failed = 0;
  std::int64_t skipped = 0;  ///< because a unit that they read failed
  std::int64_t waiting = 0;  ///< left to another shard
  Counts counts;             ///< of made and reused units: in = out + rejected, unless the stage is a source
  double seconds = 0;        ///< wall clock, of this run
  std::vector<std::string> warnings;  ///< in the order of the units, equal ones once
};

/// Failed unit. The other units are not affected.
struct Failure {
  std::string unit;  ///< "find_mountain_tops/tile_000003"
  ErrorCode code = ErrorCode::input;
  std::string message;
};

/// Outcome of a run. Apart from `seconds` it does not depend on the number of threads.
struct RunReport {
  std::vector<StageReport> stages;  ///< in the order of the pipeline
  std::vector<Failure> failures;    ///< in the order of the units
  double seconds = 0;

  /// Returns whether every unit was made or reused.
  bool complete() const;
  /// Returns the exit code (interface.md): 0 for success, 2 if a unit rejected an option, else 3 if units
  /// failed.
  int exit_code() const;
};

/// Returns a readable table, one line per stage, with rejections, warnings and failures.
std::string report_as_text(const RunReport& report);
/// Returns one indented JSON object.
std::string report_as_json(const RunReport& report);
/// Writes report_as_text().
std::ostream& operator<<(std::ostream& stream, const RunReport& report);

}  // namespace waymark::pipeline
