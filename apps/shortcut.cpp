// SPDX-License-Identifier: Apache-2.0
#include "apps/shortcut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iostream>
#include <stdexcept>

#include "core/error.hpp"
#include "pipeline/engine/registry.hpp"
#include "pipeline/engine/step.hpp"
#include "pipeline/engine/step_options.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

std::string flag_name(std::string option) {
  std::ranges::replace(option, '_', '-');
  return "--" + option;
}

std::string in_capitals(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

// Returns the placeholder of the value: its unit, its name, or N for a bare number.
std::string placeholder(const OptionRow& row) {
  if (!row.unit.empty()) return in_capitals(row.unit);
  return json_type(row.value) == "string" ? in_capitals(row.name) : "N";
}

std::string default_text(const OptionRow& row) {
  if (const auto* number = std::get_if<double>(&row.value))
    return fmt::format("{:g}{}{}", *number, row.unit.empty() ? "" : " ", row.unit);
  if (const auto* integer = std::get_if<std::int64_t>(&row.value)) return std::to_string(*integer);
  if (const auto* text = std::get_if<std::string>(&row.value)) return *text;
  return "";
}

// Returns the engine's message with the option as it was typed: --min-prominence, not
// find_mountain_tops.min_prominence.
Error as_typed(const Error& error, const std::string& place, const std::string& flag) {
  std::string problem = error.problem();
  if (const auto at = problem.find(place); at != std::string::npos) problem.replace(at, place.size(), flag);
  return Error(error.code(), problem, "", error.hint());
}

}  // namespace

StageOptions::StageOptions(const std::vector<std::string_view>& names) {
  for (const std::string_view name : names) {
    const std::size_t dot = name.find('.');
    const std::string stage(name.substr(0, dot));
    const auto rows = option_table(workflows::all_stages().at(stage));
    const auto row = std::ranges::find(rows, name.substr(dot + 1), &OptionRow::name);
    if (row == rows.end()) throw std::logic_error("no stage has the option " + std::string(name));
    offered_.push_back({stage, *row, ""});
  }
}

std::vector<Argument> StageOptions::arguments() {
  std::vector<Argument> all;
  for (Offered& option : offered_)
    all.push_back(
        Argument{flag_name(option.row.name), placeholder(option.row), &option.given, option.row.field.help}
            .one_of(option.row.field.choices)
            .or_else(default_text(option.row))
            .formerly(option.row.field.formerly.empty() ? "" : flag_name(option.row.field.formerly)));
  return all;
}

void StageOptions::apply(pipeline::Pipeline& pipeline) const {
  for (const Offered& option : offered_) {
    if (option.given.empty()) continue;
    const std::string place = option.stage + "." + option.row.name;
    const auto is_its_stage = [&](const auto& step) { return step->spec().name == option.stage; };
    if (std::ranges::none_of(pipeline.steps(), is_its_stage))
      throw Error(ErrorCode::usage,
                  fmt::format("{} is an option of {}, which this job does not have",
                              flag_name(option.row.name), option.stage),
                  "", "--print-job shows the stages");
    try {
      pipeline.set(place + "=" + option.given);
    } catch (const Error& error) {
      throw as_typed(error, place, flag_name(option.row.name));
    }
  }
}

CommandSpec Shortcut::describe() {
  CommandSpec spec = describe_own();
  spec.result = map_result_keys();
  for (auto& argument : map_arguments(asked_)) spec.arguments.push_back(std::move(argument));
  for (auto& argument : options_.arguments()) spec.arguments.push_back(std::move(argument));
  spec.arguments.push_back(
      {"--print-job", "", &print_job_, "Print the job instead of running it: the start of one of your own"});
  return spec;
}

int Shortcut::run(const Session& session) {
  pipeline::Pipeline pipeline(workflows::all_stages());
  add_stages(pipeline);
  options_.apply(pipeline);
  const pipeline::Job job{describe_own().name, std::move(pipeline)};
  if (!print_job_) return make_map_command(job, asked_, session);
  std::cout << pipeline::job_as_json(job.name, job.pipeline) << '\n';
  return 0;
}

}  // namespace waymark::apps
