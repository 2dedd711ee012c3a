// SPDX-License-Identifier: Apache-2.0
// How a run processes one unit: reuse a stored result, run the stage, or record why not.
#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <utility>

#include "pipeline/engine/run/run.hpp"
#include "pipeline/engine/run/work_division.hpp"

namespace waymark::pipeline {

using Status = UnitState::Status;

void Run::do_unit(std::size_t stage, std::size_t unit, ProgressMeter& progress) {
  UnitState& state = states_[unit];
  const auto needs = [&](auto predicate) {
    return std::ranges::any_of(wires_[stage], [&](const Wire& wire) {
      const auto [first, last] = units_read(plan_, wire, unit - plan_.begins[stage]);
      return std::any_of(states_.begin() + static_cast<std::ptrdiff_t>(first),
                         states_.begin() + static_cast<std::ptrdiff_t>(last),
                         [&](const UnitState& read) { return predicate(read, wire); });
    });
  };
  if (state.assignment == UnitAssignment::none) return;
  const bool rerun = state.assignment == UnitAssignment::own && rerun_[stage];
  if (store_ && !rerun && reuse(stage, unit)) return progress.add(1);
  if (state.assignment == UnitAssignment::foreign) return;
  if (needs([](const UnitState& read, const Wire& wire) { return read.is_missing() && !wire.gathers; })) {
    state.status = Status::skipped;
    return progress.add(1);
  }
  if (needs([](const UnitState& read, const Wire&) { return !read.ready() && !read.is_missing(); })) return;
  if (gathers_nothing(stage, unit)) {
    state.status = Status::skipped;
    return progress.add(1);
  }
  state.partial = needs([](const UnitState& read, const Wire&) { return read.is_missing() || read.partial; });
  make(stage, unit, progress);
}

/// Returns whether all units of a gathering port have failed.
bool Run::gathers_nothing(std::size_t stage, std::size_t unit) const {
  std::map<std::string, std::pair<bool, bool>> found_failed;
  for (const Wire& wire : wires_[stage]) {
    const auto [first, last] = units_read(plan_, wire, unit - plan_.begins[stage]);
    auto& [found, lost] = found_failed[wire.port];
    for (std::size_t i = first; i < last; ++i) (states_[i].ready() ? found : lost) = true;
  }
  return std::ranges::any_of(found_failed, [](const auto& port) {
    const auto [found, lost] = port.second;
    return lost && !found;
  });
}

bool Run::reuse(std::size_t stage, std::size_t unit) {
  const StageSpec& spec = step(stage).spec();
  auto stored = store_->find(plan_.units[unit], spec);
  if (!stored) return false;
  if (planning_[stage]) {  // decoded now: fails if its input files have moved
    try {
      for (const auto& [port, artifact] : stored->artifacts) artifact->value();
    } catch (const Error&) {
      store_->remove(plan_.units[unit]);
      return false;
    }
  }
  UnitState& state = states_[unit];
  state.status = Status::reused;
  state.outcome.counts = std::move(stored->counts);
  state.outcome.warnings = std::move(stored->warnings);
  state.artifacts = std::move(stored->artifacts);
  return true;
}

void Run::make(std::size_t stage, std::size_t unit, ProgressMeter& meter) {
  UnitState& state = states_[unit];
  const Unit& what = plan_.units[unit];
  const StageSpec& spec = step(stage).spec();
  UnitProgress progress(meter);
  UnitInputs inputs = unit_inputs(stage, unit);
  // The single unit of a map-scope stage may be the last owner of its inputs and take them.
  if (spec.scope == Scope::map) release_read(stage);
  if (options_.progress) inputs.progress = [&](double done) { progress.advance_to(done); };
  StageContext context(spec, inputs);
  try {
    // Isolated: a thread that waits inside a stage must not start another unit.
    tbb::this_task_arena::isolate([&] { step(stage).run(context); });
  } catch (const std::logic_error&) {
    throw;  // a stage that breaks its declaration is a bug, not a bad input
  } catch (const std::exception& problem) {
    if (planning_[stage]) throw;  // the plan needs its items
    const auto* error = dynamic_cast<const Error*>(&problem);
    state.failure = {what.id(), error ? error->code() : ErrorCode::environment, problem.what()};
    state.status = Status::failed;
    if (store_) store_->save_failure(what, problem.what());
    return progress.advance_to(1);
  }
  state.outcome = context.finish();
  warn_about_missing_inputs(stage, unit);
  if (store_ && rerun_[stage]) store_->remove(what);
  const bool saved = store_ && !state.partial && state.outcome.keep;
  if (saved) store_->save(what, spec, state.outcome);
  auto outputs = std::exchange(state.outcome.outputs, {});
  for (const OutputPort& port : spec.outputs) {
    Artifact::Value& value = outputs.at(port.name);
    state.artifacts[port.name] = saved && port.codec->parts ? store_->artifact(what, spec, port)
                                 : !is_offloaded(stage, port.name)
                                     ? std::make_shared<Artifact>(std::move(value))
                                 : saved ? store_->artifact(what, spec, port)
                                         : offload(stage, port, std::move(value));
  }
  state.status = Status::made;
  progress.advance_to(1);
}

/// Returns whether an artifact is kept out of memory: it belongs to a tile and no map-scope stage reads it,
/// except as a stream. Otherwise a map-scope stage would hold all of them at once, so nothing would be saved.
bool Run::is_offloaded(std::size_t stage, const std::string& port) const {
  if (step(stage).spec().scope != Scope::tile) return false;
  for (std::size_t later = stage + 1; later < wires_.size(); ++later)
    for (const Wire& wire : wires_[later])
      if (wire.writer == stage && wire.port == port && !wire.same_item && !wire.streams) return false;
  return true;
}

ArtifactPtr Run::offload(std::size_t stage, const OutputPort& port, Artifact::Value value) {
  const std::shared_ptr<ScratchFile>& file = scratch_[stage];  // lives as long as its artifacts
  return std::make_shared<Artifact>(
      [file, codec = port.codec, read = file->put(port.codec->encode(value.get()))] {
        return codec->decode(read());
      },
      Artifact::Retention::release);
}

void Run::warn_about_missing_inputs(std::size_t stage, std::size_t unit) {
  for (const Wire& wire : wires_[stage]) {
    const auto [first, last] = units_read(plan_, wire, unit - plan_.begins[stage]);
    std::size_t lost = 0;
    for (std::size_t i = first; i < last; ++i) lost += states_[i].is_missing() ? 1 : 0;
    if (lost > 0)
      states_[unit].outcome.warnings.push_back(
          fmt::format("made without {} of {} results of {}, which failed", lost, last - first,
                      step(wire.writer).spec().name));
  }
}

UnitInputs Run::unit_inputs(std::size_t stage, std::size_t unit) const {
  const Unit& what = plan_.units[unit];
  UnitInputs inputs{.id = what.id(),
                    .tile = what.tile,
                    .image = what.image,
                    .base_folder = pipeline_.base_folder,
                    .threads = tbb::this_task_arena::max_concurrency(),
                    .types = types_,
                    .progress = {},
                    .scratch = options_.work.empty() ? options_.scratch : options_.work};
  for (const Wire& wire : wires_[stage]) {
    PortInput& input = inputs.ports[wire.port];
    const bool all_items = !wire.same_item && step(wire.writer).spec().scope != Scope::map;
    input.many = wire.gathers || all_items;
    const auto [first, last] = units_read(plan_, wire, unit - plan_.begins[stage]);
    for (std::size_t i = first; i < last; ++i)
      if (states_[i].ready()) input.items.push_back(states_[i].artifacts.find(wire.port)->second);
  }
  return inputs;
}

}  // namespace waymark::pipeline
