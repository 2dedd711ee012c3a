// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/run/work_division.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

namespace waymark::pipeline {
namespace {

[[noreturn]] void refuse_division(std::string problem, std::string hint) {
  throw Error(ErrorCode::usage, std::move(problem), {}, std::move(hint));
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& names) {
  const std::string near = nearest_name(name, names);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", near);
}

/// Selects the unit at a place to run; the units that it reads are only reused.
void select(const Plan& plan, std::size_t at, std::vector<UnitState>& states) {
  for (const std::size_t read : plan.units[at].after)
    if (states[read].assignment == UnitAssignment::none) states[read].assignment = UnitAssignment::foreign;
  states[at].assignment = UnitAssignment::own;
}

void select_nothing(std::vector<UnitState>& states) {
  for (UnitState& state : states) state.assignment = UnitAssignment::none;
}

void select_of_stage(const Plan& plan, const std::string& stage,
                     const std::function<bool(const Unit&)>& is_in_shard, std::vector<UnitState>& states) {
  select_nothing(states);
  for (std::size_t i = 0; i < states.size(); ++i)
    if (plan.units[i].stage == stage && is_in_shard(plan.units[i])) select(plan, i, states);
}

void select_unit(const Plan& plan, const std::string& id, std::vector<UnitState>& states) {
  const auto wanted = std::ranges::find(plan.units, id, &Unit::id);
  if (wanted == plan.units.end()) {
    std::vector<std::string> ids;
    for (const Unit& unit : plan.units) ids.push_back(unit.id());
    refuse_division(fmt::format("the job has no unit '{}'{}", id, did_you_mean(id, ids)),
                    "waymark plan lists the units");
  }
  select_nothing(states);
  select(plan, static_cast<std::size_t>(wanted - plan.units.begin()), states);
}

/// Returns by index the places of the tiles in run_order().
std::vector<std::size_t> tile_ranks(const Plan& plan) {
  for (std::size_t stage = 0; stage < plan.stage_count(); ++stage) {
    if (plan.begins[stage] == plan.begins[stage + 1] || !plan.units[plan.begins[stage]].tile) continue;
    const std::vector<std::size_t> order = run_order(plan, stage);
    std::vector<std::size_t> ranks(order.size());
    for (std::size_t rank = 0; rank < order.size(); ++rank) ranks[order[rank]] = rank;
    return ranks;
  }
  return {};
}

}  // namespace

void check_run_options(const RunOptions& options, const Pipeline& pipeline) {
  if (options.threads < 0)
    refuse_division(fmt::format("cannot run with {} threads", options.threads),
                    "0 uses all threads of the machine");
  if (options.work.empty() &&
      (options.shard || !options.unit.empty() || !options.stage.empty() || !options.rerun_from.empty()))
    refuse_division("--shard, --stage, --unit and --rerun-from need the results of other runs",
                    "add --work DIR, the same for all of them");
  if (!options.unit.empty() && (options.shard || !options.stage.empty()))
    refuse_division("--unit is given together with --shard or --stage",
                    "a unit is the smallest part of a job: give --unit alone");
  if (options.shard && !(1 <= options.shard->index && options.shard->index <= options.shard->count))
    refuse_division(fmt::format("shard {}/{} does not exist", options.shard->index, options.shard->count),
                    "shards count from 1: 1/8 to 8/8");
  std::vector<std::string> names;
  for (const auto& step : pipeline.steps()) names.push_back(step->spec().name);
  const auto check_stage = [&](const std::string& stage, std::string_view purpose) {
    if (!stage.empty() && std::ranges::find(names, stage) == names.end())
      refuse_division(
          fmt::format("the job has no stage '{}' to {}{}", stage, purpose, did_you_mean(stage, names)),
          fmt::format("its stages: {}", fmt::join(names, ", ")));
  };
  check_stage(options.rerun_from, "rerun from");
  check_stage(options.stage, "run");
}

std::vector<std::size_t> run_order(const Plan& plan, std::size_t stage) {
  std::vector<std::size_t> positions(plan.begins[stage + 1] - plan.begins[stage]);
  std::iota(positions.begin(), positions.end(), std::size_t{0});
  std::ranges::stable_sort(positions, {}, [&](std::size_t position) {
    const std::optional<Tile>& tile = plan.units[plan.begins[stage] + position].tile;
    return tile ? tile->rank : 0;
  });
  return positions;
}

void divide_work(const Plan& plan, const RunOptions& options, std::vector<UnitState>& states) {
  if (!options.unit.empty()) return select_unit(plan, options.unit, states);
  const std::vector<std::size_t> ranks = options.shard ? tile_ranks(plan) : std::vector<std::size_t>{};
  const auto is_in_shard = [&](const Unit& unit) {
    const auto index = unit.index();
    if (!options.shard || !index) return true;
    const auto number = static_cast<std::size_t>(*index),
               mine = static_cast<std::size_t>(options.shard->index - 1),
               count = static_cast<std::size_t>(options.shard->count);
    return (unit.tile ? ranks.at(number) * count / ranks.size() : number % count) == mine;
  };
  if (!options.stage.empty()) return select_of_stage(plan, options.stage, is_in_shard, states);
  for (std::size_t i = 0; i < states.size(); ++i)
    states[i].assignment = is_in_shard(plan.units[i]) ? UnitAssignment::own : UnitAssignment::foreign;
}

}  // namespace waymark::pipeline
