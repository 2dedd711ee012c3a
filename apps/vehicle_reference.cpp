// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/registry_reference.hpp"
#include "core/json_text.hpp"
#include "core/options/option_table.hpp"
#include "planning/vehicle.hpp"

namespace waymark::apps {
namespace {

using Json = nlohmann::ordered_json;

std::vector<OptionRow> limits_of(const planning::Vehicle& vehicle) {
  planning::Vehicle copy = vehicle;
  std::vector<OptionRow> rows = option_table([&](OptionVisitor& option) { copy.describe(option); });
  rows.erase(rows.begin());  // the summary stands above
  return rows;
}

std::string vehicle_text(const planning::Vehicle& vehicle) {
  std::string text =
      fmt::format("{}: {}\n\n{}\nSupports (x forwards, y to the left of the middle; metres):\n", vehicle.name,
                  vehicle.summary, options_as_text(limits_of(vehicle)));
  for (const planning::Support& s : vehicle.supports)
    text += fmt::format("  x {:6.2f}  y {:6.2f}  diameter {:.2f}  width {:.2f}\n", s.x.value, s.y.value,
                        s.diameter.value, s.width.value);
  return text + fmt::format("Base: a disc of {:.2f} m radius\n", vehicle.base_radius());
}

std::string vehicle_markdown(const planning::Vehicle& vehicle) {
  std::string text = fmt::format(
      "# {}\n\n{}.\n\n```\n{}```\n\n| x, m | y, m | diameter, m | width, m |\n|---|---|---|---|\n",
      vehicle.name, vehicle.summary, options_as_text(limits_of(vehicle)));
  for (const planning::Support& s : vehicle.supports)
    text +=
        fmt::format("| {:g} | {:g} | {:g} | {:g} |\n", s.x.value, s.y.value, s.diameter.value, s.width.value);
  return text;
}

std::string vehicle_schema(const planning::Vehicle& vehicle) {
  planning::Vehicle copy = vehicle;
  planning::Support support;
  Json properties =
      Json::parse(option_schemas(option_table([&](OptionVisitor& option) { copy.describe(option); })));
  const Json one =
      Json::parse(option_schemas(option_table([&](OptionVisitor& option) { support.describe(option); })));
  properties["waymark_vehicle"] = {{"const", 1}};
  properties["supports"] = {{"type", "array"},
                            {"minItems", 3},
                            {"items",
                             {{"type", "object"},
                              {"properties", one},
                              {"required", {"x", "y", "diameter"}},
                              {"additionalProperties", false}}}};
  return Json{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", vehicle.name},
              {"description", vehicle.summary},
              {"type", "object"},
              {"properties", properties},
              {"required", {"waymark_vehicle", "supports"}}}
      .dump(2);
}

}  // namespace

std::vector<ReferenceEntry> vehicle_reference() {
  std::vector<ReferenceEntry> all;
  for (const planning::VehicleFile& file : planning::vehicle_files()) {
    const planning::Vehicle vehicle =
        planning::parse_vehicle(file.json, std::string(file.name), std::string(file.name));
    all.push_back({vehicle.name, vehicle.summary, vehicle_text(vehicle), std::string(file.json),
                   vehicle_schema(vehicle), vehicle_markdown(vehicle)});
  }
  return all;
}

}  // namespace waymark::apps
