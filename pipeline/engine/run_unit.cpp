// SPDX-License-Identifier: Apache-2.0
// What a run does with one unit of work: take what is stored, make it, or say why not.
#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <utility>

#include "pipeline/engine/run.hpp"
#include "pipeline/engine/share_of_work.hpp"

namespace waymark {

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
  if (state.part == Part::none) return;
  const bool make_anew = state.part == Part::ours && anew_[stage];
  if (store_ && !make_anew && reuse(stage, unit)) return progress.add(1);
  if (state.part == Part::others) return;
  if (needs([](const UnitState& read, const Wire& wire) { return read.lost() && !wire.gathers; })) {
    state.status = Status::skipped;
    return progress.add(1);
  }
  if (needs([](const UnitState& read, const Wire&) { return !read.ready() && !read.lost(); })) return;
  if (gathers_nothing(stage, unit)) {
    state.status = Status::skipped;
    return progress.add(1);
  }
  state.partial = needs([](const UnitState& read, const Wire&) { return read.lost() || read.partial; });
  make(stage, unit, progress);
}

/// Whether a port that gathers finds only units that failed.
bool Run::gathers_nothing(std::size_t stage, std::size_t unit) const {
  std::map<std::string, std::pair<bool, bool>> found_lost;
  for (const Wire& wire : wires_[stage]) {
    const auto [first, last] = units_read(plan_, wire, unit - plan_.begins[stage]);
    auto& [found, lost] = found_lost[wire.port];
    for (std::size_t i = first; i < last; ++i) (states_[i].ready() ? found : lost) = true;
  }
  return std::ranges::any_of(found_lost, [](const auto& port) {
    const auto [found, lost] = port.second;
    return lost && !found;
  });
}

bool Run::reuse(std::size_t stage, std::size_t unit) {
  const StageSpec& spec = step(stage).spec();
  auto stored = store_->find(plan_.units[unit], spec);
  if (!stored) return false;
  if (planning_[stage]) {  // needed at once; inputs that moved away make it fail
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
  UnitInputs inputs = inputs_of(stage, unit);
  // The only unit of its stage may be the last to hold what it reads, and take it.
  if (spec.scope == Scope::map) release_read(stage);
  if (options_.progress) inputs.progress = [&](double done) { progress.reach(done); };
  StageContext context(spec, inputs);
  try {
    // Isolated: a thread that waits inside a stage must not begin another unit on top of it.
    tbb::this_task_arena::isolate([&] { step(stage).run(context); });
  } catch (const std::logic_error&) {
    throw;  // a stage that breaks its declaration is a bug, not a bad input
  } catch (const std::exception& problem) {
    if (planning_[stage]) throw;  // without its items there is no plan
    const auto* error = dynamic_cast<const Error*>(&problem);
    state.failure = {what.id(), error ? error->code() : ErrorCode::environment, problem.what()};
    state.status = Status::failed;
    if (store_) store_->save_failure(what, problem.what());
    return progress.reach(1);
  }
  state.outcome = context.finish();
  warn_of_lost(stage, unit);
  if (store_ && anew_[stage]) store_->remove(what);
  const bool saved = store_ && !state.partial;
  if (saved) store_->save(what, spec, state.outcome);
  auto outputs = std::exchange(state.outcome.outputs, {});
  for (const OutputPort& port : spec.outputs) {
    Artifact::Value& value = outputs.at(port.name);
    state.artifacts[port.name] = !put_aside(stage, port.name) ? std::make_shared<Artifact>(std::move(value))
                                 : saved                      ? store_->artifact(what, spec, port)
                                                              : aside(stage, port, std::move(value));
  }
  state.status = Status::made;
  progress.reach(1);
}

/// Whether an artifact is kept out of memory: that of a tile which no stage of the map reads. Such a stage
/// would have all of them at once, so nothing were gained.
bool Run::put_aside(std::size_t stage, const std::string& port) const {
  if (step(stage).spec().scope != Scope::tile) return false;
  for (std::size_t later = stage + 1; later < wires_.size(); ++later)
    for (const Wire& wire : wires_[later])
      if (wire.writer == stage && wire.port == port && !wire.same_item) return false;
  return true;
}

ArtifactPtr Run::aside(std::size_t stage, const OutputPort& port, Artifact::Value value) {
  const std::shared_ptr<ScratchFile>& file = scratch_[stage];  // lives as long as an artifact in it
  return std::make_shared<Artifact>(
      [file, codec = port.codec, read = file->put(port.codec->encode(value.get()))] {
        return codec->decode(read());
      },
      Artifact::Once::let_go);
}

void Run::warn_of_lost(std::size_t stage, std::size_t unit) {
  for (const Wire& wire : wires_[stage]) {
    const auto [first, last] = units_read(plan_, wire, unit - plan_.begins[stage]);
    std::size_t lost = 0;
    for (std::size_t i = first; i < last; ++i) lost += states_[i].lost() ? 1 : 0;
    if (lost > 0)
      states_[unit].outcome.warnings.push_back(
          fmt::format("made without {} of {} results of {}, which failed", lost, last - first,
                      step(wire.writer).spec().name));
  }
}

UnitInputs Run::inputs_of(std::size_t stage, std::size_t unit) const {
  const Unit& what = plan_.units[unit];
  UnitInputs inputs{.id = what.id(),
                    .tile = what.tile,
                    .image = what.image,
                    .base_folder = pipeline_.base_folder,
                    .threads = tbb::this_task_arena::max_concurrency()};
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

}  // namespace waymark
