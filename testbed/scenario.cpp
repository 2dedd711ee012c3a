// SPDX-License-Identifier: Apache-2.0
#include "testbed/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/options/option_reader.hpp"
#include "testbed/scenario_sections.hpp"

namespace waymark::testbed {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kVersion = 1;

std::vector<Eigen::Vector2d> waypoints_of(const Json& list, const std::string& source) {
  std::vector<Eigen::Vector2d> all;
  for (const Json& at : list.is_array() ? list : Json::array()) {
    if (!at.is_array() || at.size() != 2 || !at[0].is_number() || !at[1].is_number())
      throw Error(ErrorCode::usage, fmt::format("drive.waypoints[{}] must be [east, north]", all.size()),
                  source, "metres from the middle of the site");
    all.emplace_back(at[0].get<double>(), at[1].get<double>());
  }
  if (all.size() < 2)
    throw Error(ErrorCode::usage, "drive.waypoints must be a list of at least two [east, north]", source,
                "metres from the middle of the site");
  return all;
}

DescribeOptions fields_of(const DrivePart& part, DriveSettings& drive) {
  return [&part, &drive](OptionVisitor& field) { part.describe(drive, field); };
}

// Reads the section `drive` of a scenario: its own fields, `waypoints`, and one object per part. Throws
// Error{usage} with the JSON path for fields that are unknown, out of range or of the wrong kind. Warns of
// former names.
void read_drive(DriveSettings& into, std::string_view json, const std::string& source,
                const OptionWarning& warn) {
  const Json file = Json::parse(checked_json(json, source, ErrorCode::usage));
  if (!file.is_object()) throw Error(ErrorCode::usage, "drive must be an object", source);
  into.on = true;
  std::vector<std::string> also{"waypoints"};
  for (const DrivePart& part : drive_parts())
    if (!part.name.empty()) also.push_back(part.name);
  for (const DrivePart& part : drive_parts()) {
    if (part.name.empty())
      read_and_warn(fields_of(part, into), json,
                    {.owner = "drive", .prefix = "drive.", .where = source, .also = also}, warn);
    else if (file.contains(part.name))
      read_and_warn(fields_of(part, into), file[part.name].dump(),
                    {.owner = "drive." + part.name, .prefix = "drive." + part.name + ".", .where = source},
                    warn);
  }
  if (file.contains("waypoints")) {
    into.waypoints = waypoints_of(file["waypoints"], source);
    if (!file.contains("route")) into.route = "waypoints";
  }
  constexpr std::array<std::string_view, 4> kRoutes{"waypoints", "loop", "lanes", "wander"};
  if (!into.planned() && std::ranges::find(kRoutes, into.route) == kRoutes.end())
    throw Error(ErrorCode::usage, fmt::format("drive.route must not be '{}'", into.route), source,
                "choose waypoints, loop, lanes, wander, or a file: .csv, .gpkg or .geojson");
  if (into.planned() && into.navigation.map.empty())
    throw Error(ErrorCode::usage,
                fmt::format("drive.route is the file {}, but drive.navigation.map is missing", into.route),
                source, "name the map by which the vehicle localizes");
  if (into.route == "waypoints" && into.waypoints.empty())
    throw Error(ErrorCode::usage, "drive.route is waypoints, but drive.waypoints is missing", source,
                "give a list of [east, north], metres from the middle of the site");
}

// Returns the section with all values.
std::string drive_json(const DriveSettings& drive) {
  DriveSettings copy = drive;
  Json all;
  for (const DrivePart& part : drive_parts()) {
    const Json fields = Json::parse(options_as_json(option_table(fields_of(part, copy))));
    if (part.name.empty())
      all.update(fields);
    else
      all[part.name] = fields;
  }
  if (!drive.waypoints.empty()) {
    all["waypoints"] = Json::array();
    for (const Eigen::Vector2d& at : drive.waypoints) all["waypoints"].push_back({at.x(), at.y()});
  }
  return all.dump();
}

// Returns the JSON schema of the section.
std::string drive_schema() {
  DriveSettings defaults;
  Json properties;
  std::string help;
  for (const DrivePart& part : drive_parts()) {
    const Json fields = Json::parse(option_schemas(option_table(fields_of(part, defaults))));
    if (part.name.empty())
      properties.update(fields), help = part.help;
    else
      properties[part.name] = {{"type", "object"},
                               {"description", part.help},
                               {"additionalProperties", false},
                               {"properties", fields}};
  }
  properties["waypoints"] = {
      {"type", "array"},
      {"minItems", 2},
      {"description", "[east, north] in metres from the middle of the site"},
      {"items", {{"type", "array"}, {"minItems", 2}, {"maxItems", 2}, {"items", {{"type", "number"}}}}}};
  return Json{
      {"type", "object"}, {"description", help}, {"additionalProperties", false}, {"properties", properties}}
      .dump();
}

const Json kNothing = Json::object();

void read_flights(Scenario& scenario, const Json& file, const std::string& source,
                  const OptionWarning& warn) {
  const auto given = file.find("flights");
  if (given == file.end()) return;
  if (!given->is_array() || (given->empty() && !scenario.drive.on))
    throw Error(ErrorCode::usage, "flights must be a list with at least one flight", source,
                "only a scenario with the section drive may omit them");
  scenario.flights.clear();
  for (std::size_t i = 0; i < given->size(); ++i) {
    const std::string place = fmt::format("flights[{}]", i);
    if (!(*given)[i].is_object()) throw Error(ErrorCode::usage, place + " must be an object", source);
    Flight flight;
    read_and_warn([&](OptionVisitor& field) { describe_flight(flight, field); }, (*given)[i].dump(),
                  {.owner = place, .prefix = place + ".", .where = source}, warn);
    for (const Flight& other : scenario.flights)
      if (other.name == flight.name)
        throw Error(ErrorCode::usage,
                    fmt::format("{} and an earlier flight are both called '{}'", place, flight.name), source,
                    "their images would overwrite each other: give them different names");
    if (flight.name.empty() || flight.name.find('/') != std::string::npos)
      throw Error(ErrorCode::usage, fmt::format("{}.name cannot begin a file name: '{}'", place, flight.name),
                  source, "use letters and digits");
    scenario.flights.push_back(flight);
  }
}

}  // namespace

Scenario read_scenario(std::string_view json, const std::string& source, const OptionWarning& warn) {
  Json file = Json::parse(checked_json(json, source, ErrorCode::usage));
  if (!file.is_object() || !file.contains("waymark_scenario"))
    throw Error(ErrorCode::usage, "not a scenario: \"waymark_scenario\" is missing", source,
                "a scenario begins with {\"waymark_scenario\": 1, ...}; see docs/reference/scenario.md");
  if (file["waymark_scenario"] != kVersion)
    throw Error(ErrorCode::usage,
                fmt::format("waymark_scenario is {}, this program reads {}", file["waymark_scenario"].dump(),
                            kVersion),
                source);
  Scenario scenario;
  scenario.ground.width = scenario.ground.height = 0;
  std::vector<std::string> sections{"waymark_scenario", "flights", "drive"};
  for (const ScenarioSection& section : scenario_sections())
    if (!section.name.empty()) sections.push_back(section.name);
  for (const ScenarioSection& section : scenario_sections()) {
    const Json* object = &file;
    if (!section.name.empty()) object = file.contains(section.name) ? &file[section.name] : &kNothing;
    if (!object->is_object())
      throw Error(ErrorCode::usage, fmt::format("{} must be an object", section.name), source, section.help);
    OptionLocation location{.owner = section.name, .prefix = section.name + ".", .where = source};
    if (section.name.empty()) location = {.owner = "the scenario", .where = source, .also = sections};
    read_and_warn([&](OptionVisitor& field) { section.describe(scenario, field); }, object->dump(), location,
                  warn);
  }
  if (scenario.bits != 8 && scenario.bits != 16)
    throw Error(ErrorCode::usage, fmt::format("picture.bits must be 8 or 16, is {}", scenario.bits), source);
  if (file.contains("drive")) read_drive(scenario.drive, file["drive"].dump(), source, warn);
  scenario.forest.on = file.contains("forest");
  scenario.street.on = file.contains("street");
  scenario.hall.on = file.contains("hall");
  if (scenario.forest.on + scenario.street.on + scenario.hall.on > 1)
    throw Error(ErrorCode::usage, "the scenario has several of the sections forest, street and hall", source,
                "a scenario is one place: make a file for each");
  read_flights(scenario, file, source, warn);
  return scenario;
}

std::string scenario_json(const Scenario& scenario) {
  Scenario copy = scenario;
  Json file{{"waymark_scenario", kVersion}};
  for (const ScenarioSection& section : scenario_sections()) {
    if ((section.name == "forest" && !scenario.forest.on) ||
        (section.name == "street" && !scenario.street.on) || (section.name == "hall" && !scenario.hall.on))
      continue;
    const Json fields =
        Json::parse(options_as_json(option_table([&](OptionVisitor& v) { section.describe(copy, v); })));
    if (section.name.empty())
      file.update(fields);
    else
      file[section.name] = fields;
  }
  if (scenario.drive.on) file["drive"] = Json::parse(drive_json(scenario.drive));
  file["flights"] = Json::array();
  for (Flight& flight : copy.flights)
    file["flights"].push_back(
        Json::parse(options_as_json(option_table([&](OptionVisitor& v) { describe_flight(flight, v); }))));
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
    const Json fields =
        Json::parse(option_schemas(option_table([&](OptionVisitor& v) { section.describe(defaults, v); })));
    if (section.name.empty())
      properties.update(fields);
    else
      properties[section.name] = {{"type", "object"},
                                  {"description", section.help},
                                  {"additionalProperties", false},
                                  {"properties", fields}};
  }
  properties["drive"] = Json::parse(drive_schema());
  Flight flight;
  const Json fields =
      Json::parse(option_schemas(option_table([&](OptionVisitor& v) { describe_flight(flight, v); })));
  properties["flights"] = {
      {"type", "array"},
      {"items", {{"type", "object"}, {"additionalProperties", false}, {"properties", fields}}}};
  return schema.dump(2) + "\n";
}

}  // namespace waymark::testbed
