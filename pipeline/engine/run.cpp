// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/run.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "pipeline/engine/share_of_work.hpp"

namespace waymark {
namespace {

using Status = UnitState::Status;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Which stages are `name` or read, directly or not, what it writes.
std::vector<bool> reached_from(const std::string& name, const Pipeline& pipeline,
                               const std::vector<std::vector<Wire>>& wires) {
  std::vector<bool> reached(wires.size());
  for (std::size_t stage = 0; stage < wires.size(); ++stage)
    reached[stage] =
        pipeline.steps()[stage]->spec().name == name ||
        std::ranges::any_of(wires[stage], [&](const Wire& wire) { return reached[wire.writer]; });
  return reached;
}

}  // namespace

Run::Run(const Pipeline& pipeline, const RunOptions& options) : pipeline_(pipeline), options_(options) {
  pipeline.check();
  check_run_options(options, pipeline);
  for (std::size_t stage = 0; stage < pipeline.steps().size(); ++stage)
    wires_.push_back(wires_of(pipeline, stage));
  planning_ = runs_while_planning(pipeline, wires_);
  anew_ = reached_from(options.rerun_from, pipeline, wires_);
  seconds_.resize(wires_.size());
  if (!options.work.empty()) store_.emplace(options.work);
  name_inputs();
}

void Run::name_inputs() {
  for (const auto& step : pipeline_.steps()) {
    std::vector<std::size_t> indices;
    for (const std::string& name : step->input_files()) {
      const std::string path = resolve_path(pipeline_.base_folder, name);
      const auto known = std::ranges::find(inputs_, path, &InputFile::path);
      indices.push_back(static_cast<std::size_t>(known - inputs_.begin()));
      if (known == inputs_.end()) inputs_.push_back({.path = path, .bytes = 0, .sha256 = {}});
    }
    inputs_of_stage_.push_back(std::move(indices));
  }
}

void Run::hash_inputs() {
  tbb::parallel_for(std::size_t{0}, inputs_.size(),
                    [&](std::size_t i) { inputs_[i] = options_.hash_file(inputs_[i].path); });
}

void Run::hash_images() {
  image_files_.resize(items_.images.size());
  tbb::parallel_for(std::size_t{0}, image_files_.size(), [&](std::size_t i) {
    const std::string& file = items_.images[i].file;
    if (file.empty()) return;
    try {
      image_files_[i] = options_.hash_file(file);
    } catch (const Error&) {
      image_files_[i] = {.path = file, .bytes = 0, .sha256 = {}};
    }
  });
}

void Run::make_plan(bool fingerprints) {
  for (std::size_t stage = 0; stage < wires_.size(); ++stage) {
    append_stage(fingerprints);
    if (!planning_[stage]) continue;
    run_stage(stage);
    take_items(stage);
    if (fingerprints && step(stage).spec().lists == Scope::image) hash_images();
  }
  divide_work(plan_, options_, states_);
}

void Run::take_items(std::size_t stage) {
  const auto& artifacts = states_[plan_.begins[stage]].artifacts;
  const auto take = [&]<class T>(const OutputPort& port, std::vector<T>& items) {
    if (port.type == typeid(std::vector<T>))
      items = *std::static_pointer_cast<const std::vector<T>>(artifacts.at(port.name)->value());
  };
  if (!step(stage).spec().lists) return;
  for (const OutputPort& port : step(stage).spec().outputs) {
    take(port, items_.tiles);
    take(port, items_.images);
  }
}

void Run::append_stage(bool fingerprints) {
  const std::size_t stage = plan_.stage_count();
  append_units(plan_, pipeline_, items_);
  states_.resize(plan_.units.size());
  if (!fingerprints) return;
  std::vector<InputFile> files;
  for (const std::size_t i : inputs_of_stage_[stage]) files.push_back(inputs_[i]);
  for (std::size_t i = plan_.begins[stage]; i < plan_.units.size(); ++i) {
    std::vector<InputFile> own = files;
    if (plan_.units[i].image) own.push_back(image_files_.at(i - plan_.begins[stage]));
    plan_.units[i].fingerprint = fingerprint_of(plan_, plan_.units[i], step(stage), pipeline_, own);
    plan_.units[i].done = store_ && store_->contains(plan_.units[i]);
  }
}

void Run::run_stages() {
  for (std::size_t stage = 0; stage < wires_.size(); ++stage) {
    if (!planning_[stage]) run_stage(stage);
    release_read(stage);
  }
  expect_wanted_unit();
}

void Run::expect_wanted_unit() const {
  if (options_.unit.empty()) return;
  const auto wanted = std::ranges::find(plan_.units, options_.unit, &Unit::id);
  if (states_[static_cast<std::size_t>(wanted - plan_.units.begin())].status != Status::waiting) return;
  for (const std::size_t i : wanted->after)
    if (!states_[i].ready())
      throw Error(
          ErrorCode::usage,
          fmt::format("cannot do {}: it reads {}, which is not done", options_.unit, plan_.units[i].id()),
          options_.work.string(), fmt::format("first do --unit {}", plan_.units[i].id()));
}

void Run::run_stage(std::size_t stage) {
  const auto begin = Clock::now();
  const std::size_t first = plan_.begins[stage], end = plan_.begins[stage + 1];
  ProgressMeter progress(options_.progress, step(stage).spec().name, static_cast<std::int64_t>(end - first));
  tbb::parallel_for(
      first, end, [&](std::size_t unit) { do_unit(stage, unit, progress); }, tbb::simple_partitioner());
  progress.finish();
  seconds_[stage] = seconds_since(begin);
}

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
  if (store_ && !state.partial) store_->save(what, spec, state.outcome);
  for (auto& [port, value] : std::exchange(state.outcome.outputs, {}))
    state.artifacts[port] = std::make_shared<Artifact>(std::move(value));
  state.status = Status::made;
  progress.reach(1);
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

/// Lets go of the artifacts of tiles and images that no later stage reads, unless nobody reads them at all:
/// those are results.
void Run::release_read(std::size_t stage) {
  for (const Wire& wire : wires_[stage]) {
    if (step(wire.writer).spec().scope == Scope::map) continue;
    const auto reads_it = [&](const std::vector<Wire>& later) {
      return std::ranges::any_of(
          later, [&](const Wire& other) { return other.port == wire.port && other.writer == wire.writer; });
    };
    if (std::any_of(wires_.begin() + static_cast<std::ptrdiff_t>(stage) + 1, wires_.end(), reads_it))
      continue;
    for (std::size_t i = plan_.begins[wire.writer]; i < plan_.begins[wire.writer + 1]; ++i)
      states_[i].artifacts.erase(wire.port);
  }
}

RunResult Run::result() const {
  RunResult result;
  result.inputs = inputs_;
  for (const InputFile& file : image_files_)
    if (!file.sha256.empty()) result.inputs.push_back(file);
  for (std::size_t stage = 0; stage < wires_.size(); ++stage) {
    const StageSpec& spec = step(stage).spec();
    StageReport report = stage_report(plan_, states_, stage);
    report.stage = spec.name;
    report.seconds = seconds_[stage];
    result.report.stages.push_back(std::move(report));
    for (const OutputPort& port : spec.outputs) {
      RunResult::Kept kept{port.name, port.type, spec.scope, {}};
      for (std::size_t i = plan_.begins[stage]; i < plan_.begins[stage + 1]; ++i) {
        const auto found = states_[i].artifacts.find(port.name);
        kept.items.push_back(found == states_[i].artifacts.end() ? nullptr : found->second);
      }
      result.artifacts_.push_back(std::move(kept));
    }
  }
  for (const UnitState& state : states_)
    if (state.status == Status::failed) result.report.failures.push_back(state.failure);
  return result;
}

}  // namespace waymark
