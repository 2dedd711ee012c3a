// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/step_options.hpp"

#include <fmt/format.h>

#include "core/options/option_reader.hpp"

namespace waymark::pipeline {
namespace {

DescribeOptions options_of(const Step& step) {
  return [&step](OptionVisitor& visitor) { step.show_options(visitor); };
}

DescribeOptions changeable_options(Step& step) {
  return [&step](OptionVisitor& visitor) { step.change_options(visitor); };
}

OptionLocation location_in_job(const Step& step, std::string_view location) {
  return {.owner = fmt::format("{} {}", location, step.spec().name), .prefix = fmt::format("{}.", location)};
}

}  // namespace

std::vector<OptionRow> option_table(const Step& step) {
  return option_table(options_of(step));
}

std::vector<std::string> read_options(Step& step, std::string_view json_object, std::string_view location) {
  return read_options(changeable_options(step), json_object, location_in_job(step, location));
}

std::vector<std::string> set_option(Step& step, std::string_view option, std::string_view text) {
  const std::string& stage = step.spec().name;
  return set_option(
      changeable_options(step), option, text,
      {.owner = stage, .prefix = stage + ".", .where = fmt::format("--set {}.{}={}", stage, option, text)});
}

void check_options(const Step& step, std::string_view location) {
  check_options(options_of(step), location_in_job(step, location));
}

std::string canonical_options(const Step& step) {
  return canonical_options(option_table(step));
}

}  // namespace waymark::pipeline
