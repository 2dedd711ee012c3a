// SPDX-License-Identifier: Apache-2.0
#include "testbed/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "testbed/scenario_sections.hpp"

namespace waymark {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kVersion = 1;

// Sets the fields that an object gives; remembers the names there are.
class Reader final : public OptionVisitor {
 public:
  Reader(const Json& object, std::string place, const std::string& source)
      : object_(object), place_(std::move(place)), source_(source) {}

  std::vector<std::string> names;

  void check_names(const std::vector<std::string>& also) {
    names.insert(names.end(), also.begin(), also.end());
    for (const auto& [name, value] : object_.items()) {
      if (std::ranges::find(names, name) != names.end()) continue;
      const std::string near = nearest_name(name, names);
      refuse(fmt::format("{}: no such field{}", path(name),
                         near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
             fmt::format("known here: {}", fmt::join(names, ", ")));
    }
  }
  [[noreturn]] void refuse(std::string problem, std::string hint) const {
    throw Error(ErrorCode::usage, std::move(problem), source_, std::move(hint));
  }
  std::string path(std::string_view name) const {
    return place_.empty() ? std::string(name) : fmt::format("{}.{}", place_, name);
  }

 private:
  void number(std::string_view name, double& value, std::string_view, const Field& field) override {
    if (const Json* given = find(name)) {
      if (!given->is_number()) wrong(name, "a number", *given, field);
      value = given->get<double>();
      check_range(name, value, field);
    }
  }
  void integer(std::string_view name, std::int64_t& value, const Field& field) override {
    if (const Json* given = find(name)) {
      const double number = given->is_number() ? given->get<double>() : std::nan("");
      if (!(std::nearbyint(number) == number && std::abs(number) < 0x1p53))
        wrong(name, "a whole number", *given, field);
      value = given->get<std::int64_t>();
      check_range(name, number, field);
    }
  }
  void flag(std::string_view name, bool& value, const Field& field) override {
    if (const Json* given = find(name)) {
      if (!given->is_boolean()) wrong(name, "true or false", *given, field);
      value = given->get<bool>();
    }
  }
  void text(std::string_view name, std::string& value, const Field& field) override {
    if (const Json* given = find(name)) {
      if (!given->is_string()) wrong(name, "a text", *given, field);
      value = given->get<std::string>();
      if (!field.choices.empty() && std::ranges::find(field.choices, value) == field.choices.end())
        refuse(
            fmt::format("{} must be one of {}, is '{}'", path(name), fmt::join(field.choices, ", "), value),
            field.help);
    }
  }
  void texts(std::string_view, std::vector<std::string>&, const Field&) override {}

  const Json* find(std::string_view name) {
    names.emplace_back(name);
    const auto found = object_.find(name);
    return found == object_.end() ? nullptr : &*found;
  }
  [[noreturn]] void wrong(std::string_view name, const char* kind, const Json& given,
                          const Field& field) const {
    refuse(fmt::format("{} must be {}, is {}", path(name), kind, given.dump().substr(0, 60)), field.help);
  }
  void check_range(std::string_view name, double value, const Field& field) const {
    if (field.min <= value && value <= field.max) return;
    refuse(fmt::format("{} = {} is outside [{}, {}]", path(name), value, field.min, field.max), field.help);
  }

  const Json& object_;
  std::string place_;
  const std::string& source_;
};

class Writer final : public OptionVisitor {
 public:
  Json object = Json::object();

 private:
  void number(std::string_view name, double& value, std::string_view, const Field&) override {
    object[std::string(name)] = value;
  }
  void integer(std::string_view name, std::int64_t& value, const Field&) override {
    object[std::string(name)] = value;
  }
  void flag(std::string_view name, bool& value, const Field&) override { object[std::string(name)] = value; }
  void text(std::string_view name, std::string& value, const Field&) override {
    object[std::string(name)] = value;
  }
  void texts(std::string_view, std::vector<std::string>&, const Field&) override {}
};

class SchemaWriter final : public OptionVisitor {
 public:
  Json properties = Json::object();

 private:
  Json& add(std::string_view name, const char* type, Json value, const std::string& unit,
            const Field& field) {
    Json& p = properties[std::string(name)];
    p["type"] = type;
    p["description"] = unit.empty() ? field.help : fmt::format("{} ({})", field.help, unit);
    p["default"] = std::move(value);
    if (std::isfinite(field.min)) p["minimum"] = field.min;
    if (std::isfinite(field.max)) p["maximum"] = field.max;
    if (!field.choices.empty()) p["enum"] = field.choices;
    return p;
  }
  void number(std::string_view name, double& value, std::string_view unit, const Field& field) override {
    add(name, "number", value, std::string(unit), field);
  }
  void integer(std::string_view name, std::int64_t& value, const Field& field) override {
    add(name, "integer", value, "", field);
  }
  void flag(std::string_view name, bool& value, const Field& field) override {
    add(name, "boolean", value, "", field);
  }
  void text(std::string_view name, std::string& value, const Field& field) override {
    add(name, "string", value, "", field);
  }
  void texts(std::string_view, std::vector<std::string>&, const Field&) override {}
};

const Json kNothing = Json::object();

void read_flights(Scenario& scenario, const Json& file, const std::string& source) {
  const auto given = file.find("flights");
  if (given == file.end()) return;
  if (!given->is_array() || given->empty())
    throw Error(ErrorCode::usage, "flights must be a list with at least one flight", source);
  scenario.flights.clear();
  for (std::size_t i = 0; i < given->size(); ++i) {
    const std::string place = fmt::format("flights[{}]", i);
    if (!(*given)[i].is_object()) throw Error(ErrorCode::usage, place + " must be an object", source);
    Flight flight;
    Reader reader((*given)[i], place, source);
    describe_flight(flight, reader);
    reader.check_names({});
    for (const Flight& other : scenario.flights)
      if (other.name == flight.name)
        reader.refuse(fmt::format("{} and an earlier flight are both called '{}'", place, flight.name),
                      "their images would overwrite each other: give them names");
    if (flight.name.empty() || flight.name.find('/') != std::string::npos)
      reader.refuse(fmt::format("{}.name cannot begin a file name: '{}'", place, flight.name),
                    "use letters and digits");
    scenario.flights.push_back(flight);
  }
}

}  // namespace

Scenario read_scenario(std::string_view json, const std::string& source) {
  Json file;
  try {
    file = Json::parse(json);
  } catch (const Json::parse_error& error) {
    throw Error(ErrorCode::usage, fmt::format("not JSON: {}", error.what()), source);
  }
  if (!file.is_object() || !file.contains("waymark_scenario"))
    throw Error(ErrorCode::usage, "not a scenario: \"waymark_scenario\" is missing", source,
                "a scenario begins with {\"waymark_scenario\": 1, ...}; see docs/testbed.md");
  if (file["waymark_scenario"] != kVersion)
    throw Error(ErrorCode::usage,
                fmt::format("waymark_scenario is {}, this program reads {}", file["waymark_scenario"].dump(),
                            kVersion),
                source);
  Scenario scenario;
  scenario.ground.width = scenario.ground.height = 0;
  std::vector<std::string> sections{"waymark_scenario", "flights"};
  for (const ScenarioSection& section : scenario_sections())
    if (!section.name.empty()) sections.push_back(section.name);
  for (const ScenarioSection& section : scenario_sections()) {
    const Json* object = &file;
    if (!section.name.empty()) object = file.contains(section.name) ? &file[section.name] : &kNothing;
    if (!object->is_object())
      throw Error(ErrorCode::usage, fmt::format("{} must be an object", section.name), source, section.help);
    Reader reader(*object, section.name, source);
    section.describe(scenario, reader);
    reader.check_names(section.name.empty() ? sections : std::vector<std::string>{});
  }
  if (scenario.bits != 8 && scenario.bits != 16)
    throw Error(ErrorCode::usage, fmt::format("picture.bits must be 8 or 16, is {}", scenario.bits), source);
  read_flights(scenario, file, source);
  return scenario;
}

std::string scenario_json(const Scenario& scenario) {
  Scenario copy = scenario;
  Json file{{"waymark_scenario", kVersion}};
  for (const ScenarioSection& section : scenario_sections()) {
    Writer writer;
    section.describe(copy, writer);
    if (section.name.empty())
      file.update(writer.object);
    else
      file[section.name] = writer.object;
  }
  for (Flight& flight : copy.flights) {
    Writer writer;
    describe_flight(flight, writer);
    file["flights"].push_back(writer.object);
  }
  return file.dump(2) + "\n";
}

std::string scenario_schema() {
  Scenario defaults;
  defaults.ground.width = defaults.ground.height = 0;
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Waymark scenario"},
              {"type", "object"},
              {"required", {"waymark_scenario"}},
              {"additionalProperties", false}};
  Json& properties = schema["properties"];
  properties["waymark_scenario"] = {{"const", kVersion}};
  for (const ScenarioSection& section : scenario_sections()) {
    SchemaWriter writer;
    section.describe(defaults, writer);
    if (section.name.empty())
      properties.update(writer.properties);
    else
      properties[section.name] = {{"type", "object"},
                                  {"description", section.help},
                                  {"additionalProperties", false},
                                  {"properties", writer.properties}};
  }
  SchemaWriter writer;
  Flight flight;
  describe_flight(flight, writer);
  properties["flights"] = {
      {"type", "array"},
      {"minItems", 1},
      {"items", {{"type", "object"}, {"additionalProperties", false}, {"properties", writer.properties}}}};
  return schema.dump(2) + "\n";
}

}  // namespace waymark
