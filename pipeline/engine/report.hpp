// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>
#include "core/error.hpp"
#include "pipeline/engine/stage_context.hpp"
namespace waymark {

/// What one stage did. units = made + reused + failed + skipped + waiting.
struct StageReport {
  std::string stage;
  std::int64_t units = 0;
  std::int64_t made = 0;    ///< in this run
  std::int64_t reused = 0;  ///< found in the work folder
  std::int64_t failed = 0;
  std::int64_t skipped = 0;  ///< because a unit they read failed
  std::int64_t waiting = 0;  ///< left to another share of the work
  Counts counts;             ///< of made and reused units: in = out + rejected, unless the stage is a source
  double seconds = 0;        ///< wall clock, of this run
  std::vector<std::string> warnings;  ///< in the order of the units, equal ones once
};

/// A unit that failed; the others went on.
struct Failure {
  std::string unit;  ///< "find_mountain_tops/tile_000003"
  ErrorCode code = ErrorCode::input;
  std::string message;
};

/// What a run did, the same for any number of threads, seconds aside.
struct RunReport {
  std::vector<StageReport> stages;  ///< in the order of the pipeline
  std::vector<Failure> failures;    ///< in the order of the units
  double seconds = 0;

  /// Every unit was made or reused.
  bool complete() const;
  /// 0; 2 where a unit refused an option, which no second run mends; else 3 where units failed
  /// (interface.md).
  int exit_code() const;
};

/// A table for people, one line per stage, with reasons, warnings and failures below it.
std::string report_as_text(const RunReport& report);
/// One JSON object, indented.
std::string report_as_json(const RunReport& report);
std::ostream& operator<<(std::ostream& stream, const RunReport& report);

}  // namespace waymark
