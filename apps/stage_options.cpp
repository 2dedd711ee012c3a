// SPDX-License-Identifier: Apache-2.0
#include "apps/stage_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "apps/registries.hpp"
#include "core/error.hpp"

namespace waymark {
namespace {

std::string flag_name(std::string option) {
  std::ranges::replace(option, '_', '-');
  return "--" + option;
}

/// What stands for the value: the unit in capitals, or what it is.
std::string placeholder(const OptionRow& row) {
  std::string unit = row.unit;
  std::ranges::transform(unit, unit.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (!unit.empty()) return unit;
  return json_type(row.value) == "string" ? "TEXT" : "N";
}

std::string default_text(const OptionRow& row) {
  if (const auto* number = std::get_if<double>(&row.value))
    return fmt::format("{:g}{}{}", *number, row.unit.empty() ? "" : " ", row.unit);
  if (const auto* integer = std::get_if<std::int64_t>(&row.value)) return std::to_string(*integer);
  if (const auto* text = std::get_if<std::string>(&row.value)) return *text;
  return "";
}

std::string help(const OptionRow& row) {
  const std::string value = default_text(row);
  return value.empty() ? row.field.help : row.field.help + " (default: " + value + ")";
}

}  // namespace

StageOptions::StageOptions(const std::vector<std::string_view>& names) {
  for (const std::string_view name : names) {
    const std::size_t dot = name.find('.');
    const std::string stage(name.substr(0, dot));
    const auto rows = option_table(all_stages().at(stage));
    const auto row = std::ranges::find(rows, name.substr(dot + 1), &OptionRow::name);
    if (row == rows.end()) throw std::logic_error("no stage has the option " + std::string(name));
    offered_.push_back({stage, *row, ""});
  }
}

std::vector<Argument> StageOptions::arguments() {
  std::vector<Argument> all;
  for (Offered& option : offered_)
    all.push_back({.names = flag_name(option.row.name),
                   .value = placeholder(option.row),
                   .into = &option.given,
                   .help = help(option.row),
                   .choices = option.row.field.choices});
  return all;
}

void StageOptions::apply(Pipeline& pipeline) const {
  for (const Offered& option : offered_) {
    if (option.given.empty()) continue;
    try {
      pipeline.set(option.stage + "." + option.row.name + "=" + option.given);
    } catch (const Error& error) {
      throw Error(error.code(), flag_name(option.row.name) + ": " + error.problem(), error.where(), error.hint());
    }
  }
}

}  // namespace waymark
