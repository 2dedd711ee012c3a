// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>
#include "core/options.hpp"
namespace waymark::inline core {

/// Passes the options of one object to a visitor, in the order of declaration.
using DescribeOptions = std::function<void(OptionVisitor&)>;

using OptionValue = std::variant<double, std::int64_t, bool, std::string, std::vector<std::string>>;

/// One option as data, from which help, schema, reference pages, command lines and canonical form are
/// generated.
struct OptionRow {
  std::string name;
  std::string unit;   ///< "m", "deg"; empty where there is none
  OptionValue value;  ///< current value; the default where nothing has been set
  Field field;
};

/// Returns the options in the order of declaration.
std::vector<OptionRow> option_table(const DescribeOptions& describe);

/// Returns " (formerly x)", or nothing for an option that was never renamed.
std::string former_name_remark(const OptionRow& row);

/// Returns the type in JSON schema's words: "number", "integer", "boolean", "string" or "array" (of strings).
std::string json_type(const OptionValue& value);

/// Returns the range as text, "[0, 50] m" or "at least 0 m"; empty if every number is allowed.
std::string readable_range(const OptionRow& row);

/// Returns what is wrong with a number for an option: "x = 5 is outside [0, 4] m"; empty if it is in the
/// range.
std::string range_fault(const OptionRow& row, double number);

/// Returns "name=value  effect (formerly x)", a line each.
std::string options_as_text(const std::vector<OptionRow>& rows);

/// Returns a JSON object of all values, in the order of declaration.
std::string options_as_json(const std::vector<OptionRow>& rows);

/// Returns the options that affect the result as one line of JSON, sorted by name. Equal text means equal
/// results.
std::string canonical_options(const std::vector<OptionRow>& rows);

/// Returns the `properties` of a JSON schema: types, defaults, units, ranges, choices.
std::string option_schemas(const std::vector<OptionRow>& rows);

}  // namespace waymark::inline core
