// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include "pipeline/engine/pipeline.hpp"
#include "pipeline/engine/plan.hpp"
#include "pipeline/engine/report.hpp"
namespace waymark {

/// What a run does about a unit.
enum class Part {
  ours,    ///< take it from the work folder or make it
  others,  ///< take it from the work folder, never make it
  none,    ///< do not even look
};

/// How a unit stands during a run.
struct UnitState {
  enum class Status { waiting, made, reused, failed, skipped };
  Part part = Part::ours;
  Status status = Status::waiting;
  UnitOutcome outcome;  ///< its outputs moved to `artifacts`
  std::map<std::string, ArtifactPtr, std::less<>> artifacts;
  Failure failure;
  bool partial = false;  ///< made without items that failed: not to be kept

  bool ready() const { return status == Status::made || status == Status::reused; }
  bool lost() const { return status == Status::failed || status == Status::skipped; }
};

/// Sums up the units [begin, end) of one stage, in their order.
StageReport stage_report(const Plan& plan, const std::vector<UnitState>& states, std::size_t stage);

}  // namespace waymark
