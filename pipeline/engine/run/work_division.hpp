// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/engine/run/run_state.hpp"
#include "pipeline/engine/runner.hpp"
namespace waymark::pipeline {

/// Throws Error{usage} if options contradict each other or name something that the pipeline lacks.
void check_run_options(const RunOptions& options, const Pipeline& pipeline);

/// Assigns units according to --shard, --stage or --unit; without them all units belong to this run.
/// Listing stages have already run and keep theirs. Throws Error{usage} if --unit names no unit.
void divide_work(const Plan& plan, const RunOptions& options, std::vector<UnitState>& states);

}  // namespace waymark::pipeline
