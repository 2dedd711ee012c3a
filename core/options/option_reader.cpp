// SPDX-License-Identifier: Apache-2.0
#include "core/options/option_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_text.hpp"

namespace waymark::inline core {
namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(const OptionLocation& location, std::string problem, std::string hint) {
  throw Error(ErrorCode::usage, std::move(problem), location.where, std::move(hint));
}

std::string describe_value(const Json& value) {
  const std::string type = value.type_name();
  if (value.is_null()) return "null";
  std::string text = value.dump();
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  const bool vowel = type.front() == 'a' || type.front() == 'o';
  return fmt::format("{} {} ({})", vowel ? "an" : "a", type, text);
}

class OptionReader final : public OptionVisitor {
 public:
  OptionReader(const Json& object, const OptionLocation& location) : object_(object), location_(location) {}

 private:
  void number(std::string_view name, double& value, std::string_view, const Field& field) override {
    if (const Json* given = find(name))
      value = expect(given->is_number(), name, "a number", *given, field).get<double>();
  }
  void integer(std::string_view name, std::int64_t& value, const Field& field) override {
    const Json* given = find(name);
    if (!given) return;
    const double number = given->is_number() ? given->get<double>() : std::nan("");
    const bool whole = std::nearbyint(number) == number && std::abs(number) < 0x1p63;
    value = expect(whole, name, "a whole number", *given, field).get<std::int64_t>();
  }
  void flag(std::string_view name, bool& value, const Field& field) override {
    if (const Json* given = find(name))
      value = expect(given->is_boolean(), name, "true or false", *given, field).get<bool>();
  }
  void text(std::string_view name, std::string& value, const Field& field) override {
    if (const Json* given = find(name))
      value = expect(given->is_string(), name, "a string", *given, field).get<std::string>();
  }
  void texts(std::string_view name, std::vector<std::string>& value, const Field& field) override {
    const Json* given = find(name);
    if (!given) return;
    const bool strings =
        given->is_array() && std::ranges::all_of(*given, [](const Json& s) { return s.is_string(); });
    value = expect(strings, name, "an array of strings", *given, field).get<std::vector<std::string>>();
  }

  const Json* find(std::string_view name) const {
    const auto found = object_.find(name);
    return found == object_.end() ? nullptr : &*found;
  }
  const Json& expect(bool fits, std::string_view name, const char* kind, const Json& given,
                     const Field& field) {
    if (!fits)
      refuse(location_,
             fmt::format("{}{} must be {}, is {}", location_.prefix, name, kind, describe_value(given)),
             field.help);
    return given;
  }

  const Json& object_;
  const OptionLocation& location_;
};

void check_choice(const OptionRow& row, const std::string& text, const OptionLocation& location) {
  const auto& choices = row.field.choices;
  if (choices.empty() || std::ranges::find(choices, text) != choices.end()) return;
  const std::string near = nearest_name(text, choices);
  refuse(location,
         fmt::format("{}{} must be one of {}, is '{}'{}", location.prefix, row.name, fmt::join(choices, ", "),
                     text, near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
         row.field.help);
}

void check_range(const OptionRow& row, double number, const OptionLocation& location) {
  const std::string fault = range_fault(row, number);
  if (!fault.empty()) refuse(location, location.prefix + fault, row.field.help);
}

void check_value(const OptionRow& row, const OptionLocation& location) {
  if (const auto* number = std::get_if<double>(&row.value)) check_range(row, *number, location);
  if (const auto* count = std::get_if<std::int64_t>(&row.value))
    check_range(row, static_cast<double>(*count), location);
  if (const auto* text = std::get_if<std::string>(&row.value)) check_choice(row, *text, location);
  if (const auto* texts = std::get_if<std::vector<std::string>>(&row.value))
    for (const std::string& text : *texts) check_choice(row, text, location);
}

const OptionRow* find_row(const std::vector<OptionRow>& rows, std::string_view name) {
  const auto row = std::ranges::find(rows, name, &OptionRow::name);
  return row == rows.end() ? nullptr : &*row;
}

const OptionRow* find_former(const std::vector<OptionRow>& rows, std::string_view name) {
  const auto row = std::ranges::find_if(rows, [&](const OptionRow& r) { return r.field.formerly == name; });
  return row == rows.end() || name.empty() ? nullptr : &*row;
}

[[noreturn]] void refuse_unknown(const std::vector<OptionRow>& rows, std::string_view name,
                                 const OptionLocation& location) {
  std::vector<std::string> names;
  for (const OptionRow& row : rows) names.push_back(row.name);
  names.insert(names.end(), location.also.begin(), location.also.end());
  const std::string near = nearest_name(name, names);
  refuse(location,
         fmt::format("{} has no option '{}'{}", location.owner, name,
                     near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
         names.empty() ? "it has no options" : fmt::format("its options: {}", fmt::join(names, ", ")));
}

/// Gives the values of former names their present names. Returns a warning for each.
std::vector<std::string> rename_keys(Json& object, const std::vector<OptionRow>& rows,
                                     const OptionLocation& location) {
  std::vector<std::string> warnings;
  for (const OptionRow& row : rows) {
    const std::string& former = row.field.formerly;
    if (former.empty() || !object.contains(former)) continue;
    if (object.contains(row.name))
      refuse(location,
             fmt::format("{0}{1} is the former name of {0}{2}, which is given as well", location.prefix,
                         former, row.name),
             fmt::format("give {} only", row.name));
    object[row.name] = object[former];
    object.erase(former);
    warnings.push_back(fmt::format("{}{} was renamed: use {}{}", location.prefix, former, row.name,
                                   location.where.empty() ? "" : " (" + location.where + ")"));
  }
  return warnings;
}

std::vector<std::string> read_object(const DescribeOptions& describe, Json object,
                                     const OptionLocation& location) {
  const std::vector<OptionRow> before = option_table(describe);
  std::vector<std::string> warnings = rename_keys(object, before, location);
  for (const auto& [name, value] : object.items())
    if (!find_row(before, name) && std::ranges::find(location.also, name) == location.also.end())
      refuse_unknown(before, name, location);
  OptionReader reader(object, location);
  describe(reader);
  for (const OptionRow& row : option_table(describe))
    if (object.contains(row.name)) check_value(row, location);
  return warnings;
}

/// Returns a number as JSON; unlike JSON's own it may begin with + and begin or end with the point.
Json parse_number_text(std::string_view text) {
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double number = 0;
  const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool fits = failed == std::errc() && end == digits.data() + digits.size() && std::isfinite(number);
  return fits ? Json(number) : Json(text);
}

}  // namespace

std::vector<std::string> read_options(const DescribeOptions& describe, std::string_view json_object,
                                      const OptionLocation& location) {
  const Json object = Json::parse(json_or_empty(json_object), nullptr, false);
  if (!object.is_object())
    refuse(location, fmt::format("the options of {} are not a JSON object: {}", location.owner, json_object),
           "");
  return read_object(describe, object, location);
}

void read_and_warn(const DescribeOptions& describe, std::string_view json_object,
                   const OptionLocation& location, const OptionWarning& warn) {
  for (const std::string& warning : read_options(describe, json_object, location))
    if (warn) warn(warning);
}

std::vector<std::string> set_option(const DescribeOptions& describe, std::string_view option,
                                    std::string_view text, const OptionLocation& location) {
  const std::vector<OptionRow> rows = option_table(describe);
  const OptionRow* row = find_row(rows, option);
  if (!row) row = find_former(rows, option);
  if (!row) refuse_unknown(rows, option, location);
  const std::string type = json_type(row->value);
  Json value = type == "string" ? Json(text) : Json::parse(json_or_empty(text), nullptr, false);
  if (value.is_discarded()) value = parse_number_text(text);
  if (type == "array" && !value.is_array()) value = Json::array({text});
  return read_object(describe, Json{{std::string(option), value}}, location);
}

void check_options(const DescribeOptions& describe, const OptionLocation& location) {
  for (const OptionRow& row : option_table(describe)) check_value(row, location);
}

void check_number(const std::string& name, double number, const std::string& unit, const Field& field) {
  check_range({.name = name, .unit = unit, .value = number, .field = field}, number, {});
}

}  // namespace waymark::inline core
