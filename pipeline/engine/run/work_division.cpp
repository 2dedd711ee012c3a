// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/run/work_division.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace waymark::pipeline {
namespace {

[[noreturn]] void refuse_division(std::string problem, std::string hint) {
  throw Error(ErrorCode::usage, std::move(problem), {}, std::move(hint));
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& names) {
  const std::string near = nearest_name(name, names);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", near);
}

/// Selects one unit to run; the units that it reads are only reused.
void select_unit(const Plan& plan, const std::string& id, std::vector<UnitState>& states) {
  const auto wanted = std::ranges::find(plan.units, id, &Unit::id);
  if (wanted == plan.units.end()) {
    std::vector<std::string> ids;
    for (const Unit& unit : plan.units) ids.push_back(unit.id());
    refuse_division(fmt::format("the job has no unit '{}'{}", id, did_you_mean(id, ids)),
                    "waymark plan lists the units");
  }
  for (UnitState& state : states) state.assignment = UnitAssignment::none;
  for (const std::size_t read : wanted->after) states[read].assignment = UnitAssignment::foreign;
  states[static_cast<std::size_t>(wanted - plan.units.begin())].assignment = UnitAssignment::own;
}

}  // namespace

void check_run_options(const RunOptions& options, const Pipeline& pipeline) {
  if (options.threads < 0)
    refuse_division(fmt::format("cannot run with {} threads", options.threads),
                    "0 uses all threads of the machine");
  if (options.work.empty() && (options.shard || !options.unit.empty() || !options.rerun_from.empty()))
    refuse_division("--shard, --unit and --rerun-from need the results of other runs",
                    "add --work DIR, the same for all of them");
  if (options.shard && !(1 <= options.shard->index && options.shard->index <= options.shard->count))
    refuse_division(fmt::format("shard {}/{} does not exist", options.shard->index, options.shard->count),
                    "shards count from 1: 1/8 to 8/8");
  std::vector<std::string> names;
  for (const auto& step : pipeline.steps()) names.push_back(step->spec().name);
  if (!options.rerun_from.empty() && std::ranges::find(names, options.rerun_from) == names.end())
    refuse_division(fmt::format("the job has no stage '{}' to rerun from{}", options.rerun_from,
                                did_you_mean(options.rerun_from, names)),
                    fmt::format("its stages: {}", fmt::join(names, ", ")));
}

void divide_work(const Plan& plan, const RunOptions& options, std::vector<UnitState>& states) {
  if (!options.unit.empty()) return select_unit(plan, options.unit, states);
  if (!options.shard) return;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto index = plan.units[i].index();
    const bool ours = !index || *index % options.shard->count == options.shard->index - 1;
    states[i].assignment = ours ? UnitAssignment::own : UnitAssignment::foreign;
  }
}

}  // namespace waymark::pipeline
