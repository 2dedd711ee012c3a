// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/scenario_drive.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/options/option_reader.hpp"

namespace waymark::testbed {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

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
  if (into.route == "waypoints" && into.waypoints.empty())
    throw Error(ErrorCode::usage, "drive.route is waypoints, but drive.waypoints is missing", source,
                "give a list of [east, north], metres from the middle of the site");
}

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

}  // namespace waymark::testbed
