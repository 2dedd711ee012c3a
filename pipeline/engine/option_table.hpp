// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>
#include "core/options.hpp"
#include "pipeline/engine/step.hpp"
namespace waymark {

using OptionValue = std::variant<double, std::int64_t, bool, std::string, std::vector<std::string>>;

/// One option as data: what help, schema, reference pages, command lines and the canonical form are made
/// from.
struct OptionRow {
  std::string name;
  std::string unit;   ///< "m", "deg"; empty where there is none
  OptionValue value;  ///< as it stands in the step: the default in a step from the registry
  Field field;
};

/// In the order of declaration.
std::vector<OptionRow> option_table(const Step& step);

/// "number", "integer", "boolean", "string" or "array" of strings: the words of JSON schema.
std::string json_type(const OptionValue& value);

/// "[0, 50] m", "at least 0 m"; empty where every number is allowed.
std::string readable_range(const OptionRow& row);

/// All options that affect the result, sorted by name, on one line of JSON: equal text, equal results.
std::string canonical_options(const Step& step);

}  // namespace waymark
