// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include "pipeline/engine/pipeline.hpp"
#include "pipeline/engine/report.hpp"
#include "pipeline/engine/runner.hpp"
namespace waymark::pipeline {

/// How a run treats a unit.
enum class UnitAssignment {
  own,      ///< reused from the work folder or run
  foreign,  ///< reused from the work folder, never run
  none,     ///< ignored
};

/// State of a unit during a run.
struct UnitState {
  enum class Status { waiting, made, reused, failed, skipped };
  UnitAssignment assignment = UnitAssignment::own;
  Status status = Status::waiting;
  UnitOutcome outcome;  ///< without its outputs, which are in `artifacts`
  std::map<std::string, ArtifactPtr, std::less<>> artifacts;
  Failure failure;
  bool partial = false;  ///< made without items that failed, so it is not stored

  bool ready() const { return status == Status::made || status == Status::reused; }
  bool is_missing() const { return status == Status::failed || status == Status::skipped; }
};

/// Returns the report of one stage, in the order of its units.
StageReport stage_report(const Plan& plan, const std::vector<UnitState>& states, std::size_t stage);

}  // namespace waymark::pipeline
