// SPDX-License-Identifier: Apache-2.0
#include "testbed/scenario_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"

namespace waymark {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

void read_fields(const FieldsOf& describe, std::string_view json, const std::string& place,
                 const std::string& source, const std::vector<std::string>& also) {
  const Json object = Json::parse(json);
  if (!object.is_object()) throw Error(ErrorCode::usage, fmt::format("{} must be an object", place), source);
  Reader reader(object, place, source);
  describe(reader);
  reader.check_names(also);
}

std::string written_fields(const FieldsOf& describe) {
  Writer writer;
  describe(writer);
  return writer.object.dump();
}

std::string schema_of_fields(const FieldsOf& describe) {
  SchemaWriter writer;
  describe(writer);
  return writer.properties.dump();
}

}  // namespace waymark
