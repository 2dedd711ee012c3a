// SPDX-License-Identifier: Apache-2.0
#include "planning/vehicle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/options/file_kind.hpp"
#include "core/options/option_reader.hpp"
#include "core/text_file.hpp"

namespace waymark::planning {
namespace {

using Json = nlohmann::json;

constexpr double kMirrorTolerance = 0.01;  // m

Support read_support(const Json& json, std::size_t index, const std::string& source) {
  const std::string owner = fmt::format("supports[{}]", index);
  if (!json.is_object())
    throw Error(ErrorCode::usage, fmt::format("{} is no object", owner), source,
                R"(write {"x": 1, "y": 0.5, "diameter": 0.5, "width": 0.3})");
  for (const char* key : {"x", "y", "diameter"})
    if (!json.contains(key))
      throw Error(ErrorCode::usage, fmt::format("{} has no '{}'", owner, key), source,
                  "x is forwards, y to the left of the middle; metres");
  Support support;
  read_and_warn([&](OptionVisitor& option) { support.describe(option); }, json.dump(),
                {.owner = owner, .prefix = owner + ".", .where = source}, {});
  if (!json.contains("width")) support.width = support.diameter;
  return support;
}

void check_supports(const std::vector<Support>& supports, const std::string& source) {
  if (supports.size() < 3)
    throw Error(ErrorCode::usage,
                fmt::format("a vehicle stands on three supports or more, this one on {}", supports.size()),
                source, "list every wheel or foot in \"supports\"");
  for (const Support& s : supports)
    if (std::ranges::none_of(supports, [&](const Support& other) {
          return std::abs(other.x.value - s.x.value) <= kMirrorTolerance &&
                 std::abs(other.y.value + s.y.value) <= kMirrorTolerance;
        }))
      throw Error(ErrorCode::usage,
                  fmt::format("the support at x = {:g} m, y = {:g} m has none opposite, at y = {:g} m",
                              s.x.value, s.y.value, -s.y.value),
                  source, "a wheel is missing, or one of the two positions is wrong");
  const auto [back, front] = std::ranges::minmax(supports, {}, [](const Support& s) { return s.x; });
  if (!(back.x.value < 0 && front.x.value > 0))
    throw Error(ErrorCode::usage,
                fmt::format("all supports are on one side of the middle, from x = {:g} m to {:g} m",
                            back.x.value, front.x.value),
                source, "the origin is the middle of the vehicle");
}

}  // namespace

void Support::describe(OptionVisitor& option) {
  option("x", x, {.help = "Position forwards of the middle", .min = -50, .max = 50});
  option("y", y, {.help = "Position to the left of the middle", .min = -50, .max = 50});
  option("diameter", diameter, {.help = "Diameter of the wheel or foot", .min = 0.01, .max = 20});
  option("width", width, {.help = "Width of the wheel; of a foot its diameter", .min = 0.001, .max = 20});
}

void Vehicle::describe(OptionVisitor& option) {
  option("summary", summary, {.help = "One line that describes the vehicle"});
  option("suspension", suspension,
         {.help = "How the supports follow the terrain", .choices = {"rigid", "rocker_bogie", "bogie"}});
  option("max_slope", max_slope,
         {.help = "Steepest slope of the plane under the vehicle", .min = 0.1, .max = 80});
  option("max_roughness", max_roughness,
         {.help = "Largest root mean square of the heights about that plane", .min = 0.001, .max = 10});
  option("max_step", max_step,
         {.help = "Largest change of height over a wheel's diameter beyond that of the plane",
          .min = 0.001,
          .max = 10});
  option("max_obstacle", max_obstacle,
         {.help = "Highest rock that the vehicle climbs or stands on", .min = 0.001, .max = 10});
  option("belly_clearance", belly_clearance,
         {.help = "Height of the body's lowest point above level terrain", .min = 0.001, .max = 20});
  option("mass", mass, {.help = "Mass in kilograms; 0: unknown", .min = 0, .max = 1e6});
  option("centre_of_mass", centre_of_mass,
         {.help = "Height of the centre of mass above level terrain, over the middle; 0: unknown",
          .min = 0,
          .max = 20});
}

double Vehicle::base_radius() const {
  double radius = 0;
  for (const Support& s : supports)
    radius = std::max(radius, std::hypot(s.x.value, std::abs(s.y.value) + s.width.value / 2));
  return radius;
}

double Vehicle::support_diameter() const {
  return std::ranges::min(supports, {}, [](const Support& s) { return s.diameter; }).diameter.value;
}

double Vehicle::track_width() const {
  double width = 0;
  for (const Support& s : supports) width = std::max(width, 2 * std::abs(s.y.value) + s.width.value);
  return width;
}

double Vehicle::obstacle_height() const {
  return std::min(max_obstacle.value, belly_clearance.value);
}

Vehicle parse_vehicle(std::string_view json, const std::string& name, const std::string& source) {
  check_file_kind(json, "vehicle", source);
  const Json file = Json::parse(json_or_empty(json));
  Vehicle vehicle{.name = name, .summary = {}, .supports = {}};
  read_and_warn([&](OptionVisitor& option) { vehicle.describe(option); }, json,
                {.owner = "the vehicle", .where = source, .also = {"waymark_vehicle", "name", "supports"}},
                {});
  const Json supports = file.value("supports", Json::array());
  if (!supports.is_array())
    throw Error(ErrorCode::usage, "\"supports\" is no list", source, "list every wheel or foot");
  for (std::size_t i = 0; i < supports.size(); ++i)
    vehicle.supports.push_back(read_support(supports[i], i, source));
  check_supports(vehicle.supports, source);
  return vehicle;
}

std::vector<Vehicle> built_in_vehicles() {
  std::vector<Vehicle> all;
  for (const VehicleFile& file : vehicle_files())
    all.push_back(parse_vehicle(file.json, std::string(file.name), std::string(file.name) + ".json"));
  return all;
}

Vehicle find_vehicle(const std::string& name_or_file) {
  std::vector<std::string> names;
  for (const Vehicle& vehicle : built_in_vehicles()) {
    if (vehicle.name == name_or_file) return vehicle;
    names.push_back(vehicle.name);
  }
  const std::filesystem::path path(name_or_file);
  if (path.extension() == ".json")
    return parse_vehicle(read_text(path, "the vehicle file", ErrorCode::usage), path.stem().string(),
                         name_or_file);
  const std::string nearest = nearest_name(name_or_file, names);
  throw Error(ErrorCode::usage, fmt::format("there is no vehicle '{}'", name_or_file), "",
              nearest.empty() ? "`waymark vehicles` lists them; a file ends in .json"
                              : fmt::format("did you mean '{}'? A file ends in .json", nearest));
}

}  // namespace waymark::planning
