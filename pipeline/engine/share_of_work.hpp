// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/engine/run_state.hpp"
#include "pipeline/engine/runner.hpp"
namespace waymark {

/// Throws Error{usage} for options that contradict each other or name what the pipeline does not have.
void check_run_options(const RunOptions& options, const Pipeline& pipeline);

/// Sets the part of every unit from --shard or --unit; all are ours without them. Listing stages, already
/// run, keep theirs. Throws Error{usage} where --unit names no unit.
void divide_work(const Plan& plan, const RunOptions& options, std::vector<UnitState>& states);

}  // namespace waymark
