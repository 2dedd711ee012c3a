// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/pipeline.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"
#include "pipeline/engine/plan/planner.hpp"
#include "pipeline/engine/step_options.hpp"

namespace waymark::pipeline {
namespace {

using Steps = std::vector<std::unique_ptr<Step>>;

std::string location(std::size_t index) {
  return fmt::format("stages[{}]", index);
}
std::string location(const Steps& steps, std::size_t index) {
  return fmt::format("stages[{}] {}", index, steps[index]->spec().name);
}

[[noreturn]] void refuse(std::string problem, std::string hint = {}) {
  throw Error(ErrorCode::usage, std::move(problem), {}, std::move(hint));
}

const OutputPort* find_output(const Step& step, std::string_view artifact) {
  const auto& outputs = step.spec().outputs;
  const auto port = std::ranges::find(outputs, artifact, &OutputPort::name);
  return port == outputs.end() ? nullptr : &*port;
}

std::vector<std::string> stages_where(const Registry& registry, auto predicate) {
  std::vector<std::string> names;
  for (const std::string& name : registry.names())
    if (predicate(registry.at(name))) names.push_back(name);
  return names;
}

std::string hint_to_add(const std::vector<std::string>& stages) {
  return stages.empty() ? "" : fmt::format("add before it: {}", fmt::join(stages, " or "));
}

[[noreturn]] void refuse_missing(const Steps& steps, std::size_t reader, const std::string& artifact,
                                 const Registry& registry) {
  const std::string problem =
      fmt::format("{} reads '{}', which no stage before it writes", location(steps, reader), artifact);
  for (std::size_t later = reader; later < steps.size(); ++later)
    if (find_output(*steps[later], artifact))
      refuse(problem, fmt::format("{} writes it: move it up", location(steps, later)));
  refuse(problem,
         hint_to_add(stages_where(registry, [&](const Step& s) { return find_output(s, artifact); })));
}

void check_inputs(const Steps& steps, std::size_t reader, const Registry& registry) {
  for (const InputPort& input : steps[reader]->spec().inputs) {
    std::vector<std::size_t> writers;
    for (std::size_t i = 0; i < reader; ++i)
      if (find_output(*steps[i], input.name)) writers.push_back(i);
    if (writers.empty()) refuse_missing(steps, reader, input.name, registry);
    for (const std::size_t writer : writers)
      if (const auto type = find_output(*steps[writer], input.name)->type; type != input.type)
        refuse(fmt::format("{} reads '{}' as {}, but {} writes it as {}", location(steps, reader), input.name,
                           readable_type(input.type), location(steps, writer), readable_type(type)));
    if (writers.size() > 1 && !input.gathers)
      refuse(fmt::format("{} and {} both write '{}', but {} reads only one", location(steps, writers[0]),
                         location(steps, writers[1]), input.name, location(steps, reader)));
  }
}

void check_outputs(const Steps& steps, std::size_t second) {
  for (std::size_t first = 0; first < second; ++first) {
    if (steps[first]->spec().name == steps[second]->spec().name)
      refuse(fmt::format("{} and {} are the same stage", location(steps, first), location(steps, second)));
    const auto lists = steps[first]->spec().lists;
    if (lists && lists == steps[second]->spec().lists)
      refuse(fmt::format("{} and {} both list {}s", location(steps, first), location(steps, second),
                         to_string(*lists)));
  }
}

void check_items(const Steps& steps, std::size_t index, const Registry& registry) {
  const Scope scope = steps[index]->spec().scope;
  const auto lists_them = [&](const Step& step) { return step.spec().lists == scope; };
  if (scope == Scope::map) return;
  for (std::size_t earlier = 0; earlier < index; ++earlier)
    if (lists_them(*steps[earlier])) return;
  refuse(fmt::format("{} works on {}s, but no stage before it lists them", location(steps, index),
                     to_string(scope)),
         hint_to_add(stages_where(registry, lists_them)));
}

/// Checks that listing stages and their inputs have map scope, since they run once, while planning.
void check_listing(const Pipeline& pipeline) {
  std::vector<std::vector<Wire>> wires;
  for (std::size_t i = 0; i < pipeline.steps().size(); ++i) wires.push_back(stage_wires(pipeline, i));
  const auto planning = runs_while_planning(pipeline, wires);
  for (std::size_t i = 0; i < wires.size(); ++i)
    if (planning[i] && pipeline.steps()[i]->spec().scope != Scope::map)
      refuse(fmt::format("{} runs {} by {}, but a stage that lists reads it while planning",
                         location(pipeline.steps(), i), to_string(pipeline.steps()[i]->spec().scope),
                         to_string(pipeline.steps()[i]->spec().scope)));
}

}  // namespace

Pipeline& Pipeline::add(std::string_view stage, std::string_view options_json) {
  auto step = [&] {
    try {
      return registry_->at(stage).clone();
    } catch (const Error& error) {
      refuse(location(steps_.size()) + ": " + error.problem(), error.hint());
    }
  }();
  if (!options_json.empty()) add_warnings(read_options(*step, options_json, location(steps_.size())));
  return add(std::move(step));
}

Pipeline& Pipeline::add(std::unique_ptr<Step> step) {
  check_options(*step, location(steps_.size()));
  steps_.push_back(std::move(step));
  return *this;
}

Pipeline& Pipeline::set(std::string_view assignment) {
  const std::size_t dot = assignment.find('.'), equals = assignment.find('=');
  if (equals == std::string_view::npos || dot >= equals)
    refuse(fmt::format("'{}' is not STAGE.OPTION=VALUE", assignment),
           "as in find_mountain_tops.min_prominence=25");
  const std::string_view stage = assignment.substr(0, dot);
  std::vector<std::string> names;
  for (const auto& step : steps_) {
    names.push_back(step->spec().name);
    if (names.back() != stage) continue;
    add_warnings(
        set_option(*step, assignment.substr(dot + 1, equals - dot - 1), assignment.substr(equals + 1)));
    return *this;
  }
  const std::string near = nearest_name(stage, names);
  refuse(fmt::format("the job has no stage '{}'{}", stage,
                     near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
         fmt::format("its stages: {}", fmt::join(names, ", ")));
}

void Pipeline::add_warnings(const std::vector<std::string>& warnings) {
  warnings_.insert(warnings_.end(), warnings.begin(), warnings.end());
}

const Step* Pipeline::find_writer(std::string_view artifact) const {
  for (const auto& step : steps_)
    if (find_output(*step, artifact)) return step.get();
  return nullptr;
}

void Pipeline::check() const {
  if (steps_.empty()) refuse("the job has no stages");
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    check_inputs(steps_, i, *registry_);
    check_outputs(steps_, i);
    check_items(steps_, i, *registry_);
  }
  check_listing(*this);
}

}  // namespace waymark::pipeline
