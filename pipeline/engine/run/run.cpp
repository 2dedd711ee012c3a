// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/run/run.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "pipeline/engine/run/work_division.hpp"

namespace waymark::pipeline {
namespace {

using Status = UnitState::Status;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Returns per stage whether it is `name` or depends on it.
std::vector<bool> dependent_stages(const std::string& name, const Pipeline& pipeline,
                                   const std::vector<std::vector<Wire>>& wires) {
  std::vector<bool> dependent(wires.size());
  for (std::size_t stage = 0; stage < wires.size(); ++stage)
    dependent[stage] =
        pipeline.steps()[stage]->spec().name == name ||
        std::ranges::any_of(wires[stage], [&](const Wire& wire) { return dependent[wire.writer]; });
  return dependent;
}

}  // namespace

Run::Run(const Pipeline& pipeline, const RunOptions& options)
    : pipeline_(pipeline), options_(options), types_(options.types) {
  if (!types_) {
    register_landmark_types(built_in_types_);
    types_ = &built_in_types_;
  }
  types_fingerprint_ = types_fingerprint(*types_);
  pipeline.check();
  check_run_options(options, pipeline);
  for (std::size_t stage = 0; stage < pipeline.steps().size(); ++stage)
    wires_.push_back(stage_wires(pipeline, stage));
  planning_ = runs_while_planning(pipeline, wires_);
  rerun_ = dependent_stages(options.rerun_from, pipeline, wires_);
  seconds_.resize(wires_.size());
  if (!options.work.empty()) store_.emplace(options.work);
  for (std::size_t stage = 0; stage < wires_.size(); ++stage)
    scratch_.push_back(std::make_shared<ScratchFile>(options.scratch, options.max_bytes_in_memory));
  collect_input_paths();
}

void Run::collect_input_paths() {
  for (const auto& step : pipeline_.steps()) {
    std::vector<std::size_t> indices;
    for (const std::string& name : step->input_files()) {
      const std::string path = resolve_path(pipeline_.base_folder, name);
      const auto known = std::ranges::find(inputs_, path, &InputFile::path);
      indices.push_back(static_cast<std::size_t>(known - inputs_.begin()));
      if (known == inputs_.end()) inputs_.push_back({.path = path, .bytes = 0, .sha256 = {}});
    }
    stage_inputs_.push_back(std::move(indices));
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
  for (std::size_t stage = 0; stage < wires_.size(); ++stage) check_inputs(stage);
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

/// Lets a stage compare its options with the map-scope artifacts that planning made.
void Run::check_inputs(std::size_t stage) const {
  UnitInputs inputs{.id = step(stage).spec().name, .base_folder = pipeline_.base_folder, .types = types_};
  for (const Wire& wire : wires_[stage]) {
    PortInput& input = inputs.ports[wire.port];
    input.many = wire.gathers;
    if (!planning_[wire.writer] || step(wire.writer).spec().scope != Scope::map) continue;
    const UnitState& state = states_[plan_.begins[wire.writer]];
    if (state.ready()) input.items.push_back(state.artifacts.at(wire.port));
  }
  StageContext context(step(stage).spec(), inputs);
  step(stage).check_inputs(context);
}

void Run::append_stage(bool fingerprints) {
  const std::size_t stage = plan_.stage_count();
  append_units(plan_, pipeline_, items_);
  states_.resize(plan_.units.size());
  if (!fingerprints) return;
  std::vector<InputFile> files;
  for (const std::size_t i : stage_inputs_[stage]) files.push_back(inputs_[i]);
  UnitFingerprints fingerprints_of(plan_, pipeline_, step(stage), types_fingerprint_);
  for (std::size_t i = plan_.begins[stage]; i < plan_.units.size(); ++i) {
    std::vector<InputFile> own = files;
    if (plan_.units[i].image) own.push_back(image_files_.at(i - plan_.begins[stage]));
    plan_.units[i].fingerprint = fingerprints_of.of(plan_.units[i], own);
    plan_.units[i].done = store_ && store_->contains(plan_.units[i]);
  }
}

void Run::run_stages() {
  for (std::size_t stage = 0; stage < wires_.size(); ++stage) {
    if (!planning_[stage]) run_stage(stage);
    release_read(stage);
  }
  expect_selected_units();
}

void Run::expect_selected_units() const {
  if (options_.unit.empty() && options_.stage.empty()) return;
  for (std::size_t selected = 0; selected < states_.size(); ++selected) {
    if (states_[selected].assignment != UnitAssignment::own || states_[selected].status != Status::waiting)
      continue;
    for (const std::size_t i : plan_.units[selected].after)
      if (!states_[i].ready())
        throw Error(ErrorCode::usage,
                    fmt::format("cannot do {}: it reads {}, which is not done", plan_.units[selected].id(),
                                plan_.units[i].id()),
                    options_.work.string(),
                    options_.unit.empty() ? fmt::format("first do --stage {}", plan_.units[i].stage)
                                          : fmt::format("first do --unit {}", plan_.units[i].id()));
  }
}

void Run::run_stage(std::size_t stage) {
  const auto begin = Clock::now();
  const std::size_t first = plan_.begins[stage], end = plan_.begins[stage + 1];
  ProgressMeter progress(options_.progress, step(stage).spec().name, static_cast<std::int64_t>(end - first));
  const std::vector<std::size_t> order = run_order(plan_, stage);
  tbb::parallel_for(
      std::size_t{0}, order.size(), [&](std::size_t i) { do_unit(stage, first + order[i], progress); },
      tbb::simple_partitioner());
  progress.finish();
  seconds_[stage] = seconds_since(begin);
}

/// Returns whether the caller may ask for the artifact that this stage reads. Artifacts without readers are
/// always results and are not asked about here.
bool Run::wanted(const Wire& wire) const {
  if (step(wire.writer).spec().scope != Scope::map) return false;
  return options_.results.empty() || std::ranges::count(options_.results, wire.port) > 0;
}

/// Releases artifacts that no later stage reads, unless they are results.
void Run::release_read(std::size_t stage) {
  for (const Wire& wire : wires_[stage]) {
    if (wanted(wire)) continue;
    const auto reads_it = [&](const std::vector<Wire>& later) {
      return std::ranges::any_of(
          later, [&](const Wire& other) { return other.port == wire.port && other.writer == wire.writer; });
    };
    if (std::any_of(wires_.begin() + static_cast<std::ptrdiff_t>(stage) + 1, wires_.end(), reads_it))
      continue;
    for (std::size_t i = plan_.begins[wire.writer]; i < plan_.begins[wire.writer + 1]; ++i)
      states_[i].artifacts.erase(wire.port);
    scratch_[wire.writer].reset();  // remaining artifacts share ownership
  }
}

/// Returns whether a unit of this image succeeded.
bool Run::is_used(const InputFile& image) const {
  for (std::size_t i = 0; i < plan_.units.size(); ++i)
    if (plan_.units[i].image && plan_.units[i].image->file == image.path && states_[i].ready()) return true;
  return false;
}

RunResult Run::result() const {
  RunResult result;
  result.inputs = inputs_;
  for (const InputFile& file : image_files_)
    if (!file.sha256.empty())
      result.inputs.push_back(file);
    else if (is_used(file))
      result.report.failures.push_back(
          {file.path, ErrorCode::input, "the image could not be read a second time, to record its hash"});
  for (std::size_t stage = 0; stage < wires_.size(); ++stage) {
    const StageSpec& spec = step(stage).spec();
    StageReport report = stage_report(plan_, states_, stage);
    report.stage = spec.name;
    report.seconds = seconds_[stage];
    result.report.stages.push_back(std::move(report));
    for (const OutputPort& port : spec.outputs) {
      RunResult::StoredOutput kept{spec.name, port.name, port.type, spec.scope, {}};
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

}  // namespace waymark::pipeline
