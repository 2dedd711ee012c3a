// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/engine/run/run_state.hpp"
#include "pipeline/engine/runner.hpp"
namespace waymark::pipeline {

/// Throws Error{usage} if options contradict each other or name something that the pipeline lacks.
void check_run_options(const RunOptions& options, const Pipeline& pipeline);

/// Returns the positions of a stage's units in the order in which they run: tiles by rank, others as planned.
std::vector<std::size_t> run_order(const Plan& plan, std::size_t stage);

/// Assigns units according to --shard, --stage or --unit; without them all units belong to this run.
/// Listing stages have already run and keep theirs. Throws Error{usage} if --unit names no unit.
void divide_work(const Plan& plan, const RunOptions& options, std::vector<UnitState>& states);

}  // namespace waymark::pipeline
