// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/option_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "pipeline/engine/option_table.hpp"

namespace waymark {
namespace {

using Json = nlohmann::json;

/// How messages name the stage and its options.
struct Place {
  std::string stage;   ///< "stages[1] find_mountain_tops"
  std::string prefix;  ///< "stages[1]."
  std::string where = {};
};

[[noreturn]] void refuse(const Place& place, std::string problem, std::string hint) {
  throw Error(ErrorCode::usage, std::move(problem), place.where, std::move(hint));
}

std::string with_article(const Json& value) {
  const std::string type = value.type_name();
  if (value.is_null()) return "null";
  std::string text = value.dump();
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  const bool vowel = type.front() == 'a' || type.front() == 'o';
  return fmt::format("{} {} ({})", vowel ? "an" : "a", type, text);
}

class OptionReader final : public OptionVisitor {
 public:
  OptionReader(const Json& object, const Place& place) : object_(object), place_(place) {}

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
      refuse(place_, fmt::format("{}{} must be {}, is {}", place_.prefix, name, kind, with_article(given)),
             field.help);
    return given;
  }

  const Json& object_;
  const Place& place_;
};

void check_choice(const OptionRow& row, const std::string& text, const Place& place) {
  const auto& choices = row.field.choices;
  if (choices.empty() || std::ranges::find(choices, text) != choices.end()) return;
  const std::string near = nearest_name(text, choices);
  refuse(place,
         fmt::format("{}{} must be one of {}, is '{}'{}", place.prefix, row.name, fmt::join(choices, ", "),
                     text, near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
         row.field.help);
}

void check_range(const OptionRow& row, double number, const Place& place) {
  if (row.field.min <= number && number <= row.field.max) return;  // false for NaN
  const std::string range = readable_range(row);
  const char* relation = range.empty() || range.front() == '[' ? "is outside" : "is not";
  refuse(place,
         fmt::format("{}{} = {} {} {}", place.prefix, row.name, number, relation,
                     range.empty() ? "the numbers" : range),
         row.field.help);
}

void check_values(const Step& step, const Place& place) {
  for (const OptionRow& row : option_table(step)) {
    if (const auto* number = std::get_if<double>(&row.value)) check_range(row, *number, place);
    if (const auto* count = std::get_if<std::int64_t>(&row.value))
      check_range(row, static_cast<double>(*count), place);
    if (const auto* text = std::get_if<std::string>(&row.value)) check_choice(row, *text, place);
    if (const auto* texts = std::get_if<std::vector<std::string>>(&row.value))
      for (const std::string& text : *texts) check_choice(row, text, place);
  }
}

std::vector<std::string> option_names(const Step& step) {
  std::vector<std::string> names;
  for (const OptionRow& row : option_table(step)) names.push_back(row.name);
  return names;
}

void check_name(const Step& step, std::string_view name, const Place& place) {
  const auto names = option_names(step);
  if (std::ranges::find(names, name) != names.end()) return;
  const std::string near = nearest_name(name, names);
  refuse(place,
         fmt::format("{} has no option '{}'{}", place.stage, name,
                     near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
         names.empty() ? "it has no options" : fmt::format("its options: {}", fmt::join(names, ", ")));
}

void read_object(Step& step, const Json& object, const Place& place) {
  for (const auto& [name, value] : object.items()) check_name(step, name, place);
  OptionReader reader(object, place);
  step.change_options(reader);
  check_values(step, place);
}

Place place_in_job(const Step& step, std::string_view place) {
  return {.stage = fmt::format("{} {}", place, step.spec().name), .prefix = fmt::format("{}.", place)};
}

}  // namespace

void read_options(Step& step, std::string_view json_object, std::string_view place) {
  const Json object = Json::parse(json_object, nullptr, false);
  if (!object.is_object())
    refuse(
        {},
        fmt::format("the options of {} {} are not a JSON object: {}", place, step.spec().name, json_object),
        "");
  read_object(step, object, place_in_job(step, place));
}

void set_option(Step& step, std::string_view option, std::string_view text) {
  const std::string stage = step.spec().name;
  const Place place{
      .stage = stage, .prefix = stage + ".", .where = fmt::format("--set {}.{}={}", stage, option, text)};
  check_name(step, option, place);
  const auto rows = option_table(step);
  const std::string type = json_type(std::ranges::find(rows, option, &OptionRow::name)->value);
  Json value = type == "string" ? Json(text) : Json::parse(text, nullptr, false);
  if (value.is_discarded()) value = Json(text);
  if (type == "array" && !value.is_array()) value = Json::array({text});
  read_object(step, Json{{std::string(option), value}}, place);
}

void check_options(const Step& step, std::string_view place) {
  check_values(step, place_in_job(step, place));
}

}  // namespace waymark
